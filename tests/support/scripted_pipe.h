// A cable on which everything that the device says was written down beforehand.
#pragma once

#include "dicot/mtp_host/usb_pipe.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace dicot::test {

using UsbBytes = std::vector<std::byte>;

/// "0C000000 0300": what is no digit separates.
inline UsbBytes bytes_of_hex(std::string_view hex)
{
    UsbBytes bytes;
    int high = -1;
    for (const char c : hex) {
        if (std::isxdigit(static_cast<unsigned char>(c)) == 0)
            continue;
        const int digit = c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10;
        if (high >= 0)
            bytes.push_back(static_cast<std::byte>(high * 16 + digit));
        high = high >= 0 ? -1 : digit;
    }
    return bytes;
}

inline std::string hex_of_bytes(std::span<const std::byte> bytes)
{
    std::string hex;
    for (const std::byte one : bytes)
        for (const int digit : {std::to_integer<int>(one) >> 4, std::to_integer<int>(one) & 15})
            hex.push_back("0123456789ABCDEF"[digit]);
    return hex;
}

/// Transfers come in their order, whatever is asked; once there are none, the device is silent.
class ScriptedPipe final : public mtp::UsbPipe
{
public:
    static constexpr std::size_t kPacket = 512;

    /// A transfer of the device; one of whole packets has an empty packet behind it, if `empty_packet`.
    void say(UsbBytes bytes, bool empty_packet = true)
    {
        const bool whole = bytes.size() % kPacket == 0 && !bytes.empty();
        transfers_.push_back({std::move(bytes), empty_packet || !whole, Fault::kOk});
    }
    void say(std::string_view hex) { say(bytes_of_hex(hex)); }
    void fail(Fault fault) { transfers_.push_back({{}, true, fault}); }

    std::size_t packet_bytes() const override { return kPacket; }
    Status send(std::span<const std::byte> bytes, int) override
    {
        sent.push_back(hex_of_bytes(bytes));
        return {};
    }
    Result<Piece> receive(std::span<std::byte> into, int) override
    {
        ++receives;
        if (transfers_.empty())
            return failure(Fault::kTryAgain, "silence");
        Transfer& next = transfers_.front();
        if (next.fault != Fault::kOk) {
            const Fault fault = next.fault;
            transfers_.pop_front();
            return failure(fault, "as the script says");
        }
        const std::size_t count = std::min(into.size(), next.bytes.size());
        std::copy_n(next.bytes.begin(), count, into.begin());
        const bool ended = count < into.size() && next.ends;
        const bool over = count == next.bytes.size() && (ended || !next.ends || count % kPacket != 0);
        next.bytes.erase(next.bytes.begin(), next.bytes.begin() + static_cast<std::ptrdiff_t>(count));
        if (over || ended)
            transfers_.pop_front();
        return Piece{count, ended};
    }
    Status cancel(std::uint32_t transaction) override
    {
        sent.push_back("cancel " + std::to_string(transaction));
        return {};
    }
    /// What a device in its right mind does: all that it was about to say is gone.
    Status reset() override
    {
        sent.push_back("reset");
        ++resets;
        return {};
    }
    Result<std::uint16_t> status() override { return std::uint16_t{0x2001}; }
    void clear_halts() override {}

    std::vector<std::string> sent; ///< hexadecimal, or "cancel N", "reset"
    int receives = 0, resets = 0;

private:
    struct Transfer
    {
        UsbBytes bytes;
        bool ends;
        Fault fault;
    };
    std::deque<Transfer> transfers_;
};

} // namespace dicot::test
