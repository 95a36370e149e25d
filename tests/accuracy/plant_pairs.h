// The six rendered plants in two lights: pictures, truth, our depths by `best` and those of OpenCV's SGBM.
#pragma once

#include "raw_depth.h"
#include "rectified_view.h"

#include <array>
#include <string>

namespace dicot::test {

inline constexpr std::array kPlants{"p1_epipremnum", "p2_pepper",    "p3_strawberry",
                                    "p4_monstera",   "p5_aglaonema", "p6_turnip"};
inline constexpr std::array kLights{"overcast", "sunny"};

struct PlantPair
{
    std::string name;     ///< plant and light
    scenes::Picture left; ///< as the camera gave it
    RawDepth ours;        ///< own calibration
    RawDepth peer;        ///< the true calibration
};

const TrueDepth& plant_truth(std::size_t plant);
/// Rectified and matched when it is asked for first; then its rows of the table are printed and its pictures drawn.
const PlantPair& plant_pair(std::size_t plant, std::size_t light);
/// All twelve, lights of a plant together.
std::vector<const PlantPair*> all_plant_pairs();

DepthFigures leaf_figures(std::size_t plant, const RawDepth& depth);

} // namespace dicot::test
