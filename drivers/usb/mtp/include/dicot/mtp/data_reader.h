// Reads the data of a transfer, front to back, from bytes that may be anything.
#pragma once

#include "dicot/base/short_text.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace dicot::mtp {

/// Little-endian. What goes beyond the end reads as 0 or empty, and ok() is false from then on: look once, at the end.
class DataReader
{
public:
    explicit DataReader(std::span<const std::byte> bytes) noexcept : rest_(bytes) {}

    std::uint8_t u8() noexcept { return static_cast<std::uint8_t>(number(1)); }
    std::uint16_t u16() noexcept { return static_cast<std::uint16_t>(number(2)); }
    std::uint32_t u32() noexcept { return static_cast<std::uint32_t>(number(4)); }
    std::uint64_t u64() noexcept { return number(8); }
    std::int64_t i64() noexcept { return static_cast<std::int64_t>(number(8)); }
    std::span<const std::byte> bytes(std::size_t count) noexcept;
    /// The count in front of an array; more elements than there are bytes for: 0, and not ok().
    std::uint32_t count(std::size_t element_bytes) noexcept;
    /// A string: a count, then UTF-16, up to its end mark. UTF-8; halves of pairs are U+FFFD; what is longer than
    /// Capacity is cut between characters. Nothing in it is checked: it may hold control characters and slashes.
    template <std::size_t Capacity>
    ShortText<Capacity> text() noexcept
    {
        char room[Capacity];
        return std::string_view{room, text_into(room)};
    }

    bool ok() const noexcept { return ok_; }
    std::size_t left() const noexcept { return rest_.size(); }
    /// Everything was there and nothing is left over.
    bool ended() const noexcept { return ok_ && rest_.empty(); }

private:
    std::uint64_t number(std::size_t size) noexcept;
    std::size_t text_into(std::span<char> into) noexcept;

    std::span<const std::byte> rest_;
    bool ok_ = true;
};

/// "YYYYMMDDThhmmss", with tenths and with "Z" or "+hhmm" or neither: microseconds since 1970. Without a zone, as UTC.
std::optional<std::int64_t> parse_date(std::string_view text) noexcept;

} // namespace dicot::mtp
