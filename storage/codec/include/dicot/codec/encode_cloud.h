// A cloud into the bytes of a .drc file.
#pragma once

#include "dicot/base/cloud.h"
#include "dicot/base/status.h"
#include "dicot/codec/cloud_meta.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// The most points that a file may have: bounds the memory of writers and readers alike.
inline constexpr std::size_t kMaxCloudPoints = std::size_t{1} << 22;

/// What was found when the encoded bytes were decoded again, before anybody relied on them.
struct CloudProof
{
    std::uint32_t points = 0;
    std::int32_t least[3] = {}; ///< bounds of the decoded points, in grid steps
    std::int32_t most[3] = {};
    double worst_error_um = 0; ///< largest distance along an axis between a decoded float32 and its grid position
};

struct EncodedCloud
{
    std::span<const std::byte> bytes; ///< the file, lying at the start of the lent heap
    CloudProof proof;
    std::size_t heap_peak_bytes = 0; ///< what encoding and proof used of the heap (0 where operator new is not gated)
};

/// The heap that encode_cloud() needs for a cloud of `points` points on a grid of 20 bits at most, whatever they are.
std::size_t encode_heap_bytes(std::size_t points);

inline constexpr std::size_t kLeafHeapBytes = 4;

/// Encodes as storage/FORMAT.md says: points in their order, positions exactly on the grid, colours and confidences as
/// as_stored() rounds them (stored_point.h). Then decodes the result and compares every point with what was to be
/// stored: a difference is Fault::kSoftware.
/// Refused: no points, more than kMaxCloudPoints, a point outside the grid; a heap that is too small (Fault::kConfig).
/// `heap` is lent to the compressor for the call; the result lies in it afterwards. `leaf`: empty, or the number of a
/// leaf for each point, 0 for none: another attribute, which takes kLeafHeapBytes of heap a point more.
Result<EncodedCloud> encode_cloud(const PointCloud& cloud, const CloudMeta& meta, std::span<std::byte> heap,
                                  std::span<const std::uint16_t> leaf = {});

} // namespace dicot
