// What is measured on plants and on leaves.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/status.h"
#include "dicot/plant/leaves.h"
#include "dicot/plant/plant_view.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// NaN where it could not be measured.
struct Measured
{
    double value = 0;
    double sd = 0; ///< one standard deviation, of the same unit
};

struct LeafTraits
{
    int leaf = 0; ///< 1 .. leaf_count
    int plant = 0;
    std::int64_t points = 0;
    Measured length_mm;       ///< along the midrib, on the surface
    Measured width_mm;        ///< across it, on the surface, where it is widest
    Measured area_mm2;        ///< of what is visible, on the surface
    Measured inclination_deg; ///< of the blade's normal from the vertical: 0 lies flat
    Measured azimuth_deg;     ///< in which direction it points, base to tip, about up from `right`, 0 .. 360
    Measured curvature_per_m; ///< along the midrib: 1 / radius; positive: base and tip hang below the middle
    double greenness = 0;     ///< mean of (2 g - r - b) / (r + g + b)
    double centre_mm[3] = {}; ///< camera frame
    double base_mm[3] = {};
    double tip_mm[3] = {};
    bool hidden = false; ///< another surface in front of it covers a part of it
    bool cut = false;    ///< it leaves the picture or the working range
};

struct PlantTraits
{
    /// Fewer are taken for stray ones.
    static constexpr std::int64_t kHighest = 20;

    int plant = 0;
    std::int64_t points = 0;
    Measured height_max_mm;         ///< above the ground, that which kHighest points reach
    Measured height_p99_mm;         ///< above the ground, 99th percentile
    Measured height_top10_mean_mm;  ///< mean of the highest tenth
    Measured leaf_area_visible_mm2; ///< on the surface
    Measured projected_area_mm2;    ///< seen from above
    Measured hull_volume_mm3;       ///< of the convex hull
    Measured leaf_count;
    Measured inclination_mean_deg; ///< by area
    double greenness = 0;
    bool cut = false; ///< leaves the picture or the working range
};

struct Traits
{
    std::span<LeafTraits> leaves;
    std::span<PlantTraits> plants;
};

/// Measures every leaf and plant. `far_mm`: how far the cloud's working range reaches, 0 where that is not known.
/// Fault::kConfig: `arena` is smaller than traits_bytes(). What is measured how, and each sd: README.md.
Result<Traits> measure_traits(const PlantView& view, const Leaves& leaves, Arena& arena, double far_mm = 0);

/// What measure_traits() takes at most: the traits, which stay, and twice in passing what is larger.
std::size_t traits_bytes(std::size_t points, int leaf_count, int plant_count);

} // namespace dicot
