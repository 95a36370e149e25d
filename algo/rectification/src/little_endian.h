// Numbers as bytes, the lowest first.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

class ByteWriter
{
public:
    explicit ByteWriter(std::span<std::byte> into) : into_(into) {}

    void number(std::uint64_t value, std::size_t bytes)
    {
        for (std::size_t i = 0; i < bytes; ++i)
            into_[at_++] = static_cast<std::byte>(value >> (8 * i));
    }
    void real(double value) { number(std::bit_cast<std::uint64_t>(value), sizeof value); }
    void word(std::span<const char> letters)
    {
        for (const char letter : letters)
            number(static_cast<std::uint8_t>(letter), 1);
    }
    std::size_t at() const { return at_; }

private:
    std::span<std::byte> into_;
    std::size_t at_ = 0;
};

/// The caller has made sure that there are as many bytes as are asked for.
class ByteReader
{
public:
    explicit ByteReader(std::span<const std::byte> from) : from_(from) {}

    std::uint64_t wide(std::size_t bytes)
    {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i)
            value |= static_cast<std::uint64_t>(from_[at_++]) << (8 * i);
        return value;
    }
    std::uint32_t number(std::size_t bytes) { return static_cast<std::uint32_t>(wide(bytes)); }
    double real() { return std::bit_cast<double>(wide(sizeof(double))); }

private:
    std::span<const std::byte> from_;
    std::size_t at_ = 0;
};

} // namespace dicot
