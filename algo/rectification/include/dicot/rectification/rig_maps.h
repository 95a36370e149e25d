// The tables of both cameras as one run of bytes, together with what they follow from (README.md, "Bytes of a pair").
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/status.h"
#include "dicot/base/stereo_rig.h"
#include "dicot/rectification/remap_table.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

struct RigMaps
{
    RemapTable left, right;
};

/// CRC-32 of each table, and of what they were made for together with both.
struct MapChecksums
{
    std::uint32_t left = 0, right = 0, whole = 0;
};

/// Bytes that the tables of a rig with pictures of this size never exceed.
std::size_t most_map_bytes(int width, int height);

std::size_t map_bytes(const RigMaps& maps);
/// `rig` and `keep` are those that the tables were built from; `into` has map_bytes(maps) bytes.
MapChecksums write_maps(const RigMaps& maps, const StereoRig& rig, double keep, std::span<std::byte> into);

/// The tables out of bytes that may come from anywhere. `name` stands in the sentences.
/// Fault::kBadData: cut short, damaged, or made for a rig with any other number; Fault::kConfig: whole, and made for
/// this rig with another `keep`.
Result<RigMaps> read_maps(std::span<const std::byte> bytes, const StereoRig& rig, double keep, Arena& arena,
                          const char* name);

} // namespace dicot
