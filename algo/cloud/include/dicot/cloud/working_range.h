// From "what is nearer than this and farther than that" to disparities to search and a grid to store.
#pragma once

#include "dicot/base/cloud.h"
#include "dicot/base/status.h"

namespace dicot {

/// The distances along z that a cloud may hold, both ends included.
struct WorkingRange
{
    double near_mm = 0;
    double far_mm = 0;
};

/// The disparities that the matcher searches: min_disparity .. min_disparity + disparities - 1, in px.
struct DisparityRange
{
    int min_disparity = 0;
    int disparities = 0;
};

/// Bounds of a rig and of a grid for which the integer arithmetic of triangulate.h cannot overflow.
inline constexpr double kMaxFocalPx = 1 << 16;
inline constexpr double kMaxBaselineSteps = 1 << 18;
inline constexpr double kMaxPrincipalPointPx = 1 << 15;
inline constexpr int kMaxPictureSidePx = 1 << 14;
inline constexpr int kMinGridBits = 14;
inline constexpr int kMaxGridBits = 20;

/// Refuses a rig that is no rig (focal length or baseline not positive, not finite) or that exceeds the bounds above.
Status check_rig(const RigGeometry& rig);

/// Refuses a range that is no range: 0 < near < far <= 1 km.
Status check_range(const WorkingRange& range);

/// The disparities of all distances from near to far, rounded outward to whole pixels.
/// Refused with a remedy: near >= far, near <= 0, or a range wider than kMaxDisparities or than the picture.
Result<DisparityRange> disparity_range(const RigGeometry& rig, const WorkingRange& range);

/// The grid that holds every point that the left camera can see between near and far: 0.1 mm steps, its least corner at
/// the least corner of that frustum, and as many bits as the frustum needs, kMinGridBits at least. It depends on rig
/// and range only, so all snapshots of a rig share it. Refused when the frustum needs more than kMaxGridBits.
Result<CloudGrid> grid_for(const RigGeometry& rig, const WorkingRange& range);

} // namespace dicot
