// Containers as the standard has them, written by hand.
#pragma once

#include "dicot/mtp_host/initiator.h"
#include "scripted_pipe.h"

#include <cstdint>
#include <string>

namespace dicot::test {

inline std::string le32(std::uint32_t value)
{
    std::string hex;
    for (int byte = 0; byte < 4; ++byte, value >>= 8)
        for (const std::uint32_t digit : {value >> 4 & 15, value & 15})
            hex.push_back("0123456789ABCDEF"[digit]);
    return hex;
}

/// "0120": 0x2001.
inline std::string response(std::uint32_t transaction, const char* code = "0120")
{
    return "0C000000 0300" + std::string{code} + le32(transaction);
}

/// A data container around bytes; `code` as it stands on the cable.
inline std::string data(std::uint32_t transaction, const char* code, const std::string& payload)
{
    return le32(static_cast<std::uint32_t>(12 + bytes_of_hex(payload).size())) + "0200" + code + le32(transaction) +
           payload;
}

/// Of a device that knows `operations` ("1B10": GetPartialObject), "count" of them; called "Ä1", by "M", serial "S".
inline std::string device_info(const std::string& count, const std::string& operations,
                               const std::string& extension = "00")
{
    return "6400 06000000 6400" + extension + "0000" + count + operations + // the standard 1.00, Microsoft's 1.00
           "00000000 00000000 00000000 00000000"                            // events, properties, formats
           "02 4D00 0000  03 C400 3100 0000  00  02 5300 0000";
}

// "dicot.example: 1.0;" in UTF-16, with its count and end.
inline constexpr const char* kOurs =
    "14 640069006300 6F0074002E00 6500780061006D0070006C006500 3A00 2000 31002E003000 3B00 0000";

// As fast as the script.
inline constexpr mtp::Initiator::Patience kNoPatience{1000, 0, 0};

} // namespace dicot::test
