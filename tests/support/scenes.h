// The stereo pairs with ground truth that the accuracy tests measure on.
#pragma once

#include "dicot/base/disparity.h"
#include "dicot/base/image.h"

#include <string>
#include <vector>

namespace dicot::scenes {

/// A picture that owns its pixels.
struct Picture
{
    int width = 0;
    int height = 0;
    std::vector<Rgb8> pixels;

    ImageView<const Rgb8> view() const { return {pixels.data(), width, height}; }
    ImageView<Rgb8> view() { return {pixels.data(), width, height}; }
};

/// A rectified pair; ground truth in px, negative where unknown; masks as the folders' READMEs define them.
struct Scene
{
    std::string name;
    int disparities = 0;
    Picture left, right;
    std::vector<double> truth;
    std::vector<bool> nonocc, all, disc;
};

/// Error rates at a threshold, in percent of each mask's pixels.
struct ErrorRates
{
    double nonocc = 0, all = 0, disc = 0;
    double mean() const { return (nonocc + all + disc) / 3; }
};

/// True when the data folder is there; otherwise prints one line that says what was not run.
bool data_present(const char* test);

/// Middlebury v2: tsukuba, venus, teddy, cones.
std::vector<Scene> middlebury_v2();
/// Middlebury 2006 Aloe at a third of its size.
Scene aloe_third();

/// Reads a picture or stops the test program with the reason.
Picture read(const std::string& path);

ErrorRates error_rates(const Scene& scene, const DisparityMap& map, double threshold_px);

} // namespace dicot::scenes
