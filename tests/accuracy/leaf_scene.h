// Clouds of the rendered plants, and which leaf each of their points is of.
#pragma once

#include "raw_depth.h"

#include "dicot/base/cloud.h"
#include "dicot/base/stereo_rig.h"
#include "dicot/plant/ground.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace dicot::test {

/// A line of gt_leaves.csv, and what of it the left picture shows. Places in the cloud's frame.
struct TrueLeaf
{
    int id = 0;
    double length_mm = 0, width_mm = 0, area_mm2 = 0;
    Point3 base, tip;
    long pixels = 0;        ///< of the left picture as the camera gave it
    long by_both = 0;       ///< of these, what the right camera sees as well
    double visible_mm2 = 0; ///< of its surface, in these pixels
    double slant_deg = 0;   ///< of the plane through them from the horizontal

    double visible_share() const { return visible_mm2 / area_mm2; }
    /// A leaf that is to be measured: large enough, and nothing in front of it or beside the picture.
    bool whole() const { return pixels > 300 && visible_share() >= 0.9; }
};

struct LeafScene
{
    std::string name;
    std::vector<CloudPoint> points; ///< by `best`, own calibration
    CloudGrid grid;
    std::vector<int> leaf;     ///< of each point: id of the true leaf at its pixel, 0: none
    std::vector<float> off_mm; ///< of each point: its depth less the true one
    std::vector<TrueLeaf> leaves;
    std::vector<int> picture_leaf;                ///< of each pixel of the left picture as the camera gave it
    std::vector<std::int32_t> at_pixel;           ///< the point there, or -1
    double above_soil_mm = 0, above_bench_mm = 0; ///< the plant's top
    double visible_mm2 = 0;                       ///< of all its leaves
    GroundFrame ground;                           ///< the true one, z = 0 on the soil

    PointCloud cloud() const { return {points, grid}; }
};

/// rig-dev/plants, both lights of each: matched when it is asked for first.
const std::vector<LeafScene>& plant_scenes();

} // namespace dicot::test
