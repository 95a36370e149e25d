// Little-endian numbers in descriptors and headers (USB 2.0, 8.1). The caller has checked the length.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

using Bytes = std::span<const std::byte>;

inline std::uint8_t u8_at(Bytes bytes, std::size_t at) noexcept
{
    return std::to_integer<std::uint8_t>(bytes[at]);
}

inline std::uint16_t u16_at(Bytes bytes, std::size_t at) noexcept
{
    return static_cast<std::uint16_t>(u8_at(bytes, at) | (u8_at(bytes, at + 1) << 8));
}

inline std::uint32_t u32_at(Bytes bytes, std::size_t at) noexcept
{
    return u16_at(bytes, at) | (std::uint32_t{u16_at(bytes, at + 2)} << 16);
}

} // namespace dicot
