#include "trait_columns.h"

#include <array>

namespace dicot::app {

std::span<const PlantColumn> plant_columns()
{
    static constexpr std::array kColumns{
        PlantColumn{"leaf_area_visible_mm2", "mm²", "cm²", 0.01, "visible leaf area",
                    &PlantTraits::leaf_area_visible_mm2},
        PlantColumn{"height_max_mm", "mm", "mm", 1, "height", &PlantTraits::height_max_mm},
        PlantColumn{"height_p99_mm", "mm", "mm", 1, "height, 99th percentile", &PlantTraits::height_p99_mm},
        PlantColumn{"height_top10_mean_mm", "mm", "mm", 1, "height, mean of the highest tenth",
                    &PlantTraits::height_top10_mean_mm},
        PlantColumn{"projected_area_mm2", "mm²", "cm²", 0.01, "area seen from above", &PlantTraits::projected_area_mm2},
        PlantColumn{"hull_volume_mm3", "mm³", "cm³", 0.001, "volume of the convex hull", &PlantTraits::hull_volume_mm3},
        PlantColumn{"leaf_count", "", "", 1, "leaves", &PlantTraits::leaf_count},
        PlantColumn{"inclination_mean_deg", "°", "°", 1, "mean inclination of the leaves",
                    &PlantTraits::inclination_mean_deg}};
    return kColumns;
}

std::span<const LeafColumn> leaf_columns()
{
    static constexpr std::array kColumns{LeafColumn{"leaf_length_mm", &LeafTraits::length_mm},
                                         LeafColumn{"leaf_width_mm", &LeafTraits::width_mm},
                                         LeafColumn{"leaf_area_mm2", &LeafTraits::area_mm2},
                                         LeafColumn{"leaf_inclination_deg", &LeafTraits::inclination_deg},
                                         LeafColumn{"leaf_azimuth_deg", &LeafTraits::azimuth_deg},
                                         LeafColumn{"leaf_curvature_per_m", &LeafTraits::curvature_per_m}};
    return kColumns;
}

} // namespace dicot::app
