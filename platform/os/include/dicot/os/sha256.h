// SHA-256 (FIPS 180-4): what names bytes, and tells whether they arrived whole.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

using Sha256 = std::array<std::uint8_t, 32>;

/// The digest of bytes that come in parts. No heap.
class Sha256Stream
{
public:
    Sha256Stream() noexcept;

    void update(std::span<const std::byte> bytes) noexcept;
    /// Of all bytes since the beginning, or since the last finish(): afterwards the stream is empty again.
    Sha256 finish() noexcept;

private:
    static constexpr std::size_t kStateBytes = 208; // libmd's own, which stays behind its door

    alignas(8) std::byte state_[kStateBytes];
};

Sha256 sha256_of(std::span<const std::byte> bytes) noexcept;

/// 64 lower-case hexadecimal digits and a 0, as sha256sum(1) prints them.
std::array<char, 65> hex_of(const Sha256& digest) noexcept;

} // namespace dicot
