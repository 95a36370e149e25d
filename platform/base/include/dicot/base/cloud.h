// Point clouds, and the geometry that they are made with.
#pragma once

#include "dicot/base/image.h"

#include <cstdint>
#include <span>

namespace dicot {

/// A rectified stereo rig: what turns a disparity into a distance. Lengths in mm, the rest in px of the rectified
/// picture.
///
/// Z = focal_px * baseline_mm / (d + disparity_offset_px), X = (x - cx_px) Z / focal_px, Y = (y - cy_px) Z / focal_px
/// (equations 16 to 18 of the paper, with principal points). disparity_offset_px = cx_right - cx_left.
struct RigGeometry
{
    int width = 0;
    int height = 0;
    double focal_px = 0;
    double cx_px = 0;
    double cy_px = 0;
    double disparity_offset_px = 0;
    double baseline_mm = 0;
};

/// One point, in steps of the cloud's grid, in the frame of the rectified left camera: x right, y down, z forward.
/// Steps count from the camera, not from the grid's origin: metres = x * step.
struct CloudPoint
{
    std::int32_t x, y, z;
    Rgb8 colour;
    std::uint8_t confidence; ///< 0 .. 255
};
static_assert(sizeof(CloudPoint) == 16);

/// The fixed grid that positions lie on: coordinate = origin + index steps, 0 <= index < 2^bits. Chosen from the
/// working range, never from the points, so that every snapshot of a rig has the same one.
struct CloudGrid
{
    std::int32_t step_um = 100;         ///< 0.1 mm
    int bits = 14;                      ///< an axis spans 2^bits - 1 steps
    std::int32_t origin[3] = {0, 0, 0}; ///< in steps: the least x, y, z that the grid holds

    friend bool operator==(const CloudGrid&, const CloudGrid&) = default;
};

/// A borrowed cloud. Every point lies inside the grid.
struct PointCloud
{
    std::span<const CloudPoint> points;
    CloudGrid grid;
};

} // namespace dicot
