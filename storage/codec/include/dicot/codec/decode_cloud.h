// A cloud out of the bytes of a .drc file, which may come from anywhere.
#pragma once

#include "dicot/base/cloud.h"
#include "dicot/base/status.h"
#include "dicot/codec/cloud_meta.h"
#include "dicot/codec/encode_cloud.h"

#include <cstddef>
#include <span>

namespace dicot {

inline constexpr std::size_t kMaxCloudFileBytes = std::size_t{64} << 20;

/// What stands in front of the points. Read without the decompressor, so that memory can be measured out first.
struct CloudOutline
{
    std::size_t points = 0;
    std::size_t points_at = 0; ///< where they begin in the file, in bytes
    bool has_leaves = false;   ///< the number of a leaf for each point, which decode_cloud() passes over
    CloudGrid grid;
    CloudMeta meta;
};

/// Reads the outline. Accepts only what encode_cloud() writes or wrote; anything else, also a Draco file of another
/// make, is refused with `name` in the sentence (Fault::kBadData).
Result<CloudOutline> outline_of(std::span<const std::byte> file, const char* name);

/// The heap that decode_cloud() needs for a cloud of `points` points. A damaged file may ask for more: it is refused.
std::size_t decode_heap_bytes(std::size_t points);

/// Decodes into `points`, which holds exactly outline.points. Every point then lies on the grid of the outline.
/// `heap` is lent to the decompressor for the call. Fault::kBadData when the file is damaged.
Status decode_cloud(std::span<const std::byte> file, const CloudOutline& outline, const char* name,
                    std::span<std::byte> heap, std::span<CloudPoint> points);

} // namespace dicot
