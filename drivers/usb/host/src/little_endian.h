// Numbers in the order of the cable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace dicot::mtp {

/// Reads from the front; what is not there any more reads as 0 and makes it `short_of_bytes`.
class LittleEndian
{
public:
    explicit LittleEndian(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

    template <typename T>
    T take() noexcept
    {
        std::uint64_t value = 0;
        const std::span<const std::byte> raw = skip(sizeof(T));
        for (std::size_t i = raw.size(); i-- > 0;)
            value = value << 8 | std::to_integer<std::uint64_t>(raw[i]);
        return static_cast<T>(value);
    }
    /// The next `count` bytes, or none.
    std::span<const std::byte> skip(std::size_t count) noexcept
    {
        if (count > bytes_.size()) {
            short_ = true;
            bytes_ = {};
            return {};
        }
        const auto front = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return front;
    }

    std::size_t left() const noexcept { return bytes_.size(); }
    bool short_of_bytes() const noexcept { return short_; }

private:
    std::span<const std::byte> bytes_;
    bool short_ = false;
};

/// Writes one behind the other into room that is large enough.
class LittleEndianWriter
{
public:
    explicit LittleEndianWriter(std::span<std::byte> room) noexcept : room_(room) {}

    template <typename T>
    void put(T value) noexcept
    {
        auto raw = static_cast<std::uint64_t>(static_cast<std::make_unsigned_t<T>>(value));
        for (std::size_t i = 0; i < sizeof(T); ++i, raw >>= 8)
            room_[used_ + i] = static_cast<std::byte>(raw & 0xFF);
        used_ += sizeof(T);
    }
    void put(std::span<const std::byte> bytes) noexcept
    {
        for (const std::byte one : bytes)
            room_[used_++] = one;
    }
    std::span<const std::byte> written() const noexcept { return room_.first(used_); }

private:
    std::span<std::byte> room_;
    std::size_t used_ = 0;
};

} // namespace dicot::mtp
