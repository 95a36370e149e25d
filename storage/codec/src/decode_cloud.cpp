#include "dicot/codec/decode_cloud.h"

#include "dicot/os/lent_heap.h"
#include "dicot/os/shown_path.h"
#include "packed_points.h"

#include <cstdint>
#include <exception>

namespace dicot {
namespace {

// One attribute, and the entropy coder's tables: 6 MiB at most (tests/storage/codec_memory_test.cpp).
constexpr std::size_t kDecodeBytesPerPoint = 12;
constexpr std::size_t kDecodeBytesFixed = std::size_t{8} << 20;

/// Puts one attribute where it belongs; confidences as they stand in the file. False: a value that none can be.
bool place(Part part, std::span<const std::int32_t> values, const CloudGrid& grid, std::span<CloudPoint> points)
{
    const std::int32_t last = part == Part::kPosition ? (1 << grid.bits) - 1 : part == Part::kLeaf ? UINT16_MAX : 255;
    for (const std::int32_t value : values)
        if (value < 0 || value > last)
            return false;
    for (std::size_t i = 0; i < points.size() && part != Part::kLeaf; ++i) {
        const std::int32_t* read = values.data() + i * components_of(part);
        const auto byte = [read](int component) { return static_cast<std::uint8_t>(read[component]); };
        CloudPoint& point = points[i];
        if (part == Part::kPosition) {
            point.x = grid.origin[0] + read[0];
            point.y = grid.origin[1] + read[1];
            point.z = grid.origin[2] + read[2];
        } else if (part == Part::kColour) {
            point.colour = {byte(0), byte(1), byte(2)};
        } else {
            point.confidence = byte(0);
        }
    }
    return true;
}

/// From 0 .. 2^bits - 1 to 0 .. 255, to the nearest.
bool widen_confidences(std::span<CloudPoint> points, int bits)
{
    const int last = (1 << bits) - 1;
    for (CloudPoint& point : points) {
        if (point.confidence > last)
            return false;
        point.confidence = static_cast<std::uint8_t>((2 * 255 * point.confidence + last) / (2 * last));
    }
    return true;
}

} // namespace

std::size_t decode_heap_bytes(std::size_t points)
{
    return kDecodeBytesFixed + points * kDecodeBytesPerPoint;
}

Status decode_cloud(std::span<const std::byte> file, const CloudOutline& outline, const char* name,
                    std::span<std::byte> heap, std::span<CloudPoint> points)
{
    const Status damaged =
        failure(Fault::kBadData, "%s: the cloud file is damaged: copy or make it again", shown_path(name));
    if (points.size() != outline.points)
        return failure(Fault::kSoftware, "%s: room for %zu points, not %zu", shown_path(name), points.size(),
                       outline.points);
    LentHeap lent{heap};
    try {
        int confidence_bits = 0;
        const auto take = [&](Part part, std::span<const std::int32_t> values) {
            return place(part, values, outline.grid, points);
        };
        if (!unpack(file, outline, confidence_bits, take) || !widen_confidences(points, confidence_bits))
            return damaged;
    } catch (const std::exception&) { // also what a damaged file asks for beyond the heap
        return damaged;
    }
    return {};
}

} // namespace dicot
