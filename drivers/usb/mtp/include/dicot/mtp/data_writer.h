// Writes the data of a transfer, front to back, to wherever it goes.
#pragma once

#include "dicot/base/byte_sink.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace dicot::mtp {

/// Little-endian. After a failure nothing more is written; status() has the first one.
class DataWriter
{
public:
    /// The longest string: 255 with its end mark (ISO 15740, clause 5.3.2).
    static constexpr std::size_t kMostTextUnits = 254;

    explicit DataWriter(ByteSink& sink) noexcept : sink_(sink) {}

    void u8(std::uint8_t value) noexcept { number(value, 1); }
    void u16(std::uint16_t value) noexcept { number(value, 2); }
    void u32(std::uint32_t value) noexcept { number(value, 4); }
    void u64(std::uint64_t value) noexcept { number(value, 8); }
    void i64(std::int64_t value) noexcept { number(static_cast<std::uint64_t>(value), 8); }
    void bytes(std::span<const std::byte> bytes) noexcept;
    /// A count and 16-bit elements.
    void codes(std::span<const std::uint16_t> codes) noexcept;
    /// UTF-8 as a string; what is not UTF-8 becomes U+FFFD, what is longer than kMostTextUnits is cut between
    /// characters.
    void text(std::string_view utf8) noexcept;
    /// Microseconds since 1970 as "YYYYMMDDThhmmssZ".
    void date(std::int64_t us) noexcept;

    const Status& status() const noexcept { return status_; }

private:
    void number(std::uint64_t value, std::size_t size) noexcept;

    ByteSink& sink_;
    Status status_;
};

/// Counts what would be written.
class CountSink final : public ByteSink
{
public:
    Status write(std::span<const std::byte> bytes) noexcept override
    {
        count_ += bytes.size();
        return {};
    }
    std::uint64_t count() const noexcept { return count_; }

private:
    std::uint64_t count_ = 0;
};

/// Into memory that is lent. What does not fit is Fault::kSoftware, and none of it is written.
class SpanSink final : public ByteSink
{
public:
    explicit SpanSink(std::span<std::byte> room) noexcept : room_(room) {}

    Status write(std::span<const std::byte> bytes) noexcept override;
    std::span<const std::byte> written() const noexcept { return room_.first(used_); }

private:
    std::span<std::byte> room_;
    std::size_t used_ = 0;
};

} // namespace dicot::mtp
