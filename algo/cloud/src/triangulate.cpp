#include "dicot/cloud/triangulate.h"

#include <cassert>
#include <cmath>

namespace dicot {
namespace {

constexpr int kFraction = Triangulation::kFractionBits;
constexpr int kStepsBits = 18;
constexpr int kFocalBits = 16;
constexpr int kPrincipalBits = 15;
static_assert(kMaxBaselineSteps <= 1 << kStepsBits && kMaxFocalPx <= 1 << kFocalBits);
static_assert(kMaxPrincipalPointPx <= 1 << kPrincipalBits && kMaxPictureSidePx <= 1 << kPrincipalBits);
// |f b| and |(x - cx) b|, and half a divisor beside them, fit 63 bits.
static_assert(kFocalBits + kStepsBits + kFraction <= 58 && kPrincipalBits + 1 + kStepsBits + kFraction <= 58);

std::int64_t to_q24(double value)
{
    return std::llround(value * (std::int64_t{1} << kFraction));
}

/// numerator / divisor for a positive divisor, to the nearest, half away from zero.
std::int64_t nearest(std::int64_t numerator, std::int64_t divisor)
{
    const std::int64_t half = divisor / 2;
    return numerator >= 0 ? (numerator + half) / divisor : -((half - numerator) / divisor);
}

} // namespace

Result<Triangulation> triangulation_for(const RigGeometry& rig, const WorkingRange& range, const CloudGrid& grid)
{
    TRY(check_rig(rig));
    TRY(check_range(range));
    const double steps_per_mm = 1000.0 / grid.step_um;
    const double baseline_steps = rig.baseline_mm * steps_per_mm;
    if (!(baseline_steps <= kMaxBaselineSteps))
        return failure(Fault::kConfig, "a baseline of %.6g mm is more than %.0f steps of %d um: use a coarser grid",
                       rig.baseline_mm, kMaxBaselineSteps, grid.step_um);
    Triangulation how;
    how.depth_q24 = to_q24(rig.focal_px * baseline_steps);
    how.pixel_q24 = to_q24(baseline_steps);
    how.column_zero_q24 = to_q24(rig.cx_px * baseline_steps);
    how.row_zero_q24 = to_q24(rig.cy_px * baseline_steps);
    how.offset_q24 = to_q24(rig.disparity_offset_px);
    how.near_steps = std::llround(range.near_mm * steps_per_mm);
    how.far_steps = std::llround(range.far_mm * steps_per_mm);
    how.grid = grid;
    return how;
}

Triangulated triangulate(const DisparityMap& map, ImageView<const Rgb8> left, const Triangulation& how, Arena& arena)
{
    const int width = map.relative.width;
    const int height = map.relative.height;
    Triangulated result;
    result.cloud.grid = how.grid;
    const auto points = arena.take<CloudPoint>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    if (points.empty())
        return result;
    assert(left.width == width && left.height == height);

    const std::int64_t last_step = (std::int64_t{1} << how.grid.bits) - 1;
    const auto on_grid = [&](std::int64_t steps, int axis) {
        const std::int64_t index = steps - how.grid.origin[axis];
        return index >= 0 && index <= last_step;
    };
    const std::int64_t least_q24 = (std::int64_t{map.min_disparity} << kFraction) + how.offset_q24;

    PixelCount& pixels = result.pixels;
    std::size_t count = 0;
    for (int y = 0; y < height; ++y) {
        const DispQ8* disparity = map.relative.row(y);
        const std::uint8_t* confidence = map.confidence.row(y);
        const Rgb8* colour = left.row(y);
        const std::int64_t row_q24 = y * how.pixel_q24 - how.row_zero_q24;
        for (int x = 0; x < width; ++x) {
            if (disparity[x] == kDispMissing) {
                ++pixels.missing;
                continue;
            }
            const std::int64_t d_q24 = least_q24 + (std::int64_t{disparity[x]} << (kFraction - kDispFractionBits));
            if (d_q24 <= 0) {
                ++pixels.beyond;
                continue;
            }
            const std::int64_t z = nearest(how.depth_q24, d_q24);
            if (z < how.near_steps || z > how.far_steps) {
                ++(z < how.near_steps ? pixels.too_near : pixels.too_far);
                continue;
            }
            const std::int64_t across = nearest(x * how.pixel_q24 - how.column_zero_q24, d_q24);
            const std::int64_t down = nearest(row_q24, d_q24);
            if (!on_grid(across, 0) || !on_grid(down, 1) || !on_grid(z, 2)) {
                ++pixels.outside_grid;
                continue;
            }
            points[count++] = {static_cast<std::int32_t>(across), static_cast<std::int32_t>(down),
                               static_cast<std::int32_t>(z), colour[x], confidence[x]};
        }
    }
    pixels.points = static_cast<std::int64_t>(count);
    result.cloud.points = points.first(count);
    return result;
}

} // namespace dicot
