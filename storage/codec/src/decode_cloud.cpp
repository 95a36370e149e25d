#include "dicot/codec/decode_cloud.h"

#include "dicot/os/lent_heap.h"
#include "dicot/os/shown_path.h"
#include "draco_points.h"

#include <cmath>
#include <exception>

namespace dicot {
namespace {

// Measured beside the encoder's (tests/storage/codec_memory_test.cpp).
constexpr std::size_t kDecodeBytesPerPoint = 64;
constexpr std::size_t kDecodeBytesFixed = std::size_t{8} << 20;

/// The step nearest to `metres`, if it is on the grid.
bool step_of(float metres, const CloudGrid& grid, int axis, std::int32_t& step)
{
    const double steps = static_cast<double>(metres) / (grid.step_um * 1e-6);
    if (!(std::fabs(steps) < 0x1p30))
        return false;
    step = static_cast<std::int32_t>(std::lround(steps));
    const std::int64_t index = std::int64_t{step} - grid.origin[axis];
    return index >= 0 && index < (std::int64_t{1} << grid.bits);
}

bool point_of(const PlainPoint& plain, const CloudGrid& grid, CloudPoint& point)
{
    if (!(plain.confidence >= 0.0F && plain.confidence <= 1.0F))
        return false;
    point.colour = plain.colour;
    point.confidence = static_cast<std::uint8_t>(std::lround(plain.confidence * 255.0F));
    return step_of(plain.metres[0], grid, 0, point.x) && step_of(plain.metres[1], grid, 1, point.y) &&
           step_of(plain.metres[2], grid, 2, point.z);
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
        const DracoPoints decoded = DracoPoints::unpack(file, outline.points);
        if (!decoded)
            return damaged;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (!point_of(decoded.at(i), outline.grid, points[i]))
                return damaged;
    } catch (const std::exception&) { // also what a damaged file asks for beyond the heap
        return damaged;
    }
    return {};
}

} // namespace dicot
