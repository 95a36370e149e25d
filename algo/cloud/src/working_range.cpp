#include "dicot/cloud/working_range.h"

#include "dicot/base/disparity.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace dicot {
namespace {

double disparity_at(const RigGeometry& rig, double z_mm)
{
    return rig.focal_px * rig.baseline_mm / z_mm - rig.disparity_offset_px;
}

} // namespace

Status check_range(const WorkingRange& range)
{
    if (!(range.near_mm > 0) || !(range.far_mm > range.near_mm) || !(range.far_mm <= 1e6))
        return failure(
            Fault::kUsage,
            "a working range of %.6g to %.6g mm makes no sense: give --near-mm above 0 and --far-mm above it "
            "(1000000 at most)",
            range.near_mm, range.far_mm);
    return {};
}

Status check_rig(const RigGeometry& rig)
{
    const double step_mm = CloudGrid{}.step_um / 1000.0;
    if (rig.width < 1 || rig.height < 1 || rig.width > kMaxPictureSidePx || rig.height > kMaxPictureSidePx)
        return failure(Fault::kBadData,
                       "the rig has pictures of %d x %d pixels: each side must be 1 to %d; calibrate again", rig.width,
                       rig.height, kMaxPictureSidePx);
    if (!(rig.focal_px > 0) || !(rig.focal_px <= kMaxFocalPx))
        return failure(Fault::kBadData,
                       "the rig has a focal length of %.6g px: it must be above 0 and at most %.0f; "
                       "calibrate again",
                       rig.focal_px, kMaxFocalPx);
    if (!(rig.baseline_mm > 0) || !(rig.baseline_mm <= kMaxBaselineSteps * step_mm))
        return failure(Fault::kBadData,
                       "the rig has a baseline of %.6g mm: it must be above 0 and at most %.0f; "
                       "check the unit, or calibrate again",
                       rig.baseline_mm, kMaxBaselineSteps * step_mm);
    for (const double px : {rig.cx_px, rig.cy_px, rig.disparity_offset_px})
        if (!(std::fabs(px) <= kMaxPrincipalPointPx))
            return failure(Fault::kBadData,
                           "the rig has a principal point or a disparity offset of %.6g px: it must lie "
                           "within %.0f px of 0; calibrate again",
                           px, kMaxPrincipalPointPx);
    return {};
}

Result<DisparityRange> disparity_range(const RigGeometry& rig, const WorkingRange& range)
{
    TRY(check_rig(rig));
    TRY(check_range(range));
    const double least = std::floor(disparity_at(rig, range.far_mm));
    const double most = std::ceil(disparity_at(rig, range.near_mm));
    const double count = most - least + 1;
    if (count > kMaxDisparities) {
        const double widest_px = std::floor(disparity_at(rig, range.far_mm)) + kMaxDisparities - 2;
        const double near_mm = rig.focal_px * rig.baseline_mm / (widest_px + rig.disparity_offset_px);
        return failure(
            Fault::kUsage,
            "%.6g to %.6g mm are %.0f disparities, and %d is the most that can be searched: use --near-mm %.0f "
            "or more, or pictures scaled down (with their rig file)",
            range.near_mm, range.far_mm, count, kMaxDisparities, std::ceil(near_mm));
    }
    if (most >= rig.width)
        return failure(
            Fault::kUsage,
            "at %.6g mm the disparity is %.0f px, and the picture is only %d px wide: use a larger --near-mm",
            range.near_mm, most, rig.width);
    return DisparityRange{static_cast<int>(least), static_cast<int>(count)};
}

Result<CloudGrid> grid_for(const RigGeometry& rig, const WorkingRange& range)
{
    TRY(check_rig(rig));
    TRY(check_range(range));
    CloudGrid grid;
    const double steps_per_mm = 1000.0 / grid.step_um;
    const auto least_and_most = [&](double principal_px, int pixels, double& least, double& most) {
        least = most = (0 - principal_px) / rig.focal_px * range.near_mm;
        for (const double z_mm : {range.near_mm, range.far_mm})
            for (const double pixel : {0.0, pixels - 1.0}) {
                const double mm = (pixel - principal_px) / rig.focal_px * z_mm;
                least = std::min(least, mm);
                most = std::max(most, mm);
            }
    };
    double least_mm[3] = {0, 0, range.near_mm};
    double most_mm[3] = {0, 0, range.far_mm};
    least_and_most(rig.cx_px, rig.width, least_mm[0], most_mm[0]);
    least_and_most(rig.cy_px, rig.height, least_mm[1], most_mm[1]);

    double widest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        // One step of play on each side: the corner pixel's point is rounded after this.
        const double least = std::floor(least_mm[axis] * steps_per_mm) - 1;
        const double most = std::ceil(most_mm[axis] * steps_per_mm) + 1;
        widest = std::max(widest, std::max(most - least, std::fabs(least)));
        grid.origin[axis] = static_cast<std::int32_t>(std::clamp(least, -0x1p30, 0x1p30));
    }
    grid.bits = kMinGridBits;
    while (grid.bits < kMaxGridBits && widest > (1 << grid.bits) - 1)
        ++grid.bits;
    if (widest > (1 << grid.bits) - 1)
        return failure(Fault::kUsage,
                       "up to %.6g mm this rig sees a space of %.0f m, and the cloud's grid holds %.0f m: use a "
                       "smaller --far-mm",
                       range.far_mm, widest / steps_per_mm / 1000, ((1 << kMaxGridBits) - 1) * 1e-6 * grid.step_um);
    return grid;
}

} // namespace dicot
