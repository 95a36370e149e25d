// One leaf, laid along its midrib.
#pragma once

#include "leaf_surface.h"
#include "vec3.h"

#include <span>

namespace dicot {

struct Place
{
    float along, across, off; ///< in the leaf's own frame, mm
};

/// The camera's frame to the leaf's: along the midrib, across it, and off the blade's plane.
struct LeafFrame
{
    Vec3 centre, along, across, normal;

    Place place(Vec3 point) const
    {
        const Vec3 from = point - centre;
        return {static_cast<float>(dot(from, along)), static_cast<float>(dot(from, across)),
                static_cast<float>(dot(from, normal))};
    }
    Vec3 point(double s, double w, double h) const { return centre + s * along + w * across + h * normal; }
};

/// mm; ends in the camera's frame. `sinus`: the outline goes in at that end, between two lobes, as far as the petiole.
struct LeafShape
{
    LeafFrame frame;
    std::size_t blade_cells = 0;
    double area_mm2 = 0; ///< on the surface, within the outline
    double length_mm = 0, width_mm = 0;
    double curvature_per_mm = 0, curvature_sd_per_mm = 0; ///< positive: hollow on the side that `normal` points to
    double along_spacing_mm = 0, across_spacing_mm = 0;   ///< of the leaf's cells
    struct End
    {
        Vec3 point;
        bool sinus = false;
    };
    End ends[2]; ///< at the least and at the greatest `along`
};

/// Fewer cells than this have no shape.
inline constexpr std::size_t kFewestCells = 24;

/// Measures at least kFewestCells cells. `places`: as many, scratch. Those of the blade are put first: what goes on
/// where the blade has become narrow is petiole.
///
/// The frame is that of the principal axes of the surface, turned until the middles of its sections run along it. The
/// midrib is the parabola through these middles: over it, the surface's profile is as long as the leaf. Length ends
/// where the midrib leaves the leaf: between two lobes at the petiole, else at the outermost cell. Width is that of
/// the widest section, on the surface. Both have half a cell added at each end, which is what lies beyond the centres.
/// A blade bent by more than a right angle is measured too short: its sections overlap.
LeafShape leaf_shape(std::span<SurfaceCell> cells, double focal_px, std::span<Place> places);

} // namespace dicot
