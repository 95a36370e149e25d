// What dicot says to dicot beyond the standard: the data of its own operations. README.md has the bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot::mtp {

using Sha256 = std::array<std::byte, 32>;

/// One snapshot, or a miss, that is complete. 64 bytes on the cable.
struct SnapshotNote
{
    std::int64_t sequence = 0;
    std::int64_t began_us = 0; ///< since 1970, UTC; a whole second: the folder bears it
    std::uint64_t bytes = 0;   ///< of all its files, SHA256SUMS too
    std::uint32_t folder = 0;  ///< handle
    std::uint32_t files = 0;   ///< SHA256SUMS too
    bool pulled = false;
    Sha256 sums{}; ///< of SHA256SUMS: names everything in it

    friend bool operator==(const SnapshotNote&, const SnapshotNote&) = default;
};

/// A host has it, verified and synced. 40 bytes on the cable.
struct PulledNote
{
    std::int64_t sequence = 0;
    Sha256 sums{};
};

/// The time of day by the host's clock, when it wrote this.
struct TimeOffer
{
    std::int64_t now_us = 0; ///< since 1970, UTC
};

} // namespace dicot::mtp
