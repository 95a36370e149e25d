// The checksum of what is stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// CRC-32 as of IEEE 802.3 (zip, PNG, Ethernet): 0xCBF43926 for "123456789". It finds damage, not malice.
std::uint32_t crc32(std::span<const std::byte> bytes) noexcept;

} // namespace dicot
