#include "dicot/os/shown_path.h"
#include "dicot/rig/rig_file.h"

#include <cmath>
#include <utility>

namespace dicot {
namespace {

// What rounding in a text file may have done to numbers that are equal by construction.
constexpr double kSameFocal = 1e-6; // of the focal length
constexpr double kSameRowPx = 1e-3;
constexpr double kShortestBaselineMm = 1.0;

bool close(double a, double b, double tolerance)
{
    return std::fabs(a - b) <= tolerance;
}

} // namespace

Result<RigGeometry> geometry_of(const RigFile& rig, const char* name)
{
    const char* path = shown_path(name);
    for (const auto& [camera, key] : {std::pair{&rig.left, "P1"}, std::pair{&rig.right, "P2"}})
        if (!camera->projection)
            return failure(Fault::kBadData,
                           "%s: %s is missing, so the file says nothing about rectified pictures: rectify the rig "
                           "first, or add P1 and P2",
                           path, key);
    const Matrix<3, 4>& left = *rig.left.projection;
    const Matrix<3, 4>& right = *rig.right.projection;
    const double focal = left[0][0];
    for (const double other : {left[1][1], right[0][0], right[1][1]})
        if (!(focal > 0) || !close(other, focal, kSameFocal * focal))
            return failure(Fault::kBadData,
                           "%s: P1 and P2 have different or senseless focal lengths (%.6g, %.6g, %.6g, %.6g px): "
                           "rectify the rig again",
                           path, left[0][0], left[1][1], right[0][0], right[1][1]);
    if (!close(left[1][2], right[1][2], kSameRowPx) || !close(left[0][1], 0, kSameRowPx) ||
        !close(right[0][1], 0, kSameRowPx))
        return failure(Fault::kBadData,
                       "%s: P1 and P2 do not put the same point on the same row (cy %.6g and %.6g px): rectify the "
                       "rig again",
                       path, left[1][2], right[1][2]);
    for (const auto* row : {&left, &right})
        if ((*row)[2] != std::array<double, 4>{0, 0, 1, 0} || !close((*row)[1][0], 0, kSameRowPx))
            return failure(Fault::kBadData,
                           "%s: P1 or P2 is no projection of a rectified camera (its last row must be 0 0 1 0): "
                           "rectify the rig again",
                           path);
    if (left[0][3] != 0 || left[1][3] != 0)
        return failure(Fault::kBadData,
                       "%s: P1 must stand at the origin (its last column must be 0): rectify the rig again", path);
    const double baseline_mm = -right[0][3] / focal;
    if (std::fabs(right[1][3]) > std::fabs(right[0][3]))
        return failure(Fault::kBadData,
                       "%s: the cameras stand above each other: turn the pictures by 90 degrees and calibrate them "
                       "as left and right",
                       path);
    if (baseline_mm < 0)
        return failure(Fault::kBadData,
                       "%s: the baseline is %.6g mm: left and right cameras are swapped; swap the pictures and "
                       "calibrate again",
                       path, baseline_mm);
    if (!(baseline_mm >= kShortestBaselineMm))
        return failure(Fault::kBadData,
                       "%s: the baseline is %.6g mm, too short for two cameras: if the file's lengths are metres, "
                       "add the line 'unit: m'",
                       path, baseline_mm);

    RigGeometry geometry;
    geometry.width = rig.width;
    geometry.height = rig.height;
    geometry.focal_px = focal;
    geometry.cx_px = left[0][2];
    geometry.cy_px = left[1][2];
    geometry.disparity_offset_px = right[0][2] - left[0][2];
    geometry.baseline_mm = baseline_mm;
    return geometry;
}

} // namespace dicot
