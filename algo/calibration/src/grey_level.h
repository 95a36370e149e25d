// A smoothed picture in floating point, and the pyramid that leads to it.
#pragma once

#include "dicot/base/image.h"

#include <cstdint>
#include <vector>

namespace dicot::calibration {

struct GreyLevel
{
    int width = 0;
    int height = 0;
    std::vector<float> pixels;

    float at(int x, int y) const
    {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    bool contains(double x, double y, double margin) const
    {
        return x >= margin && y >= margin && x <= width - 1 - margin && y <= height - 1 - margin;
    }
    /// Bilinear; positions outside are moved to the border.
    float sample(double x, double y) const;
};

/// Gaussian smoothing, borders repeated.
GreyLevel smooth(ImageView<const std::uint8_t> grey, double sigma_px);

/// An 8-bit picture of its own.
struct GreyPicture
{
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;
    ImageView<const std::uint8_t> view() const { return {pixels.data(), width, height}; }
};

/// The grey levels that a share of the pixels stays below: 1 % and 99 %.
struct GreyRange
{
    int dark = 0;
    int bright = 0;
};
GreyRange grey_range(ImageView<const std::uint8_t> grey);

/// The same picture with `range` stretched over all levels and dark levels drawn apart, so that an edge between light
/// and shade is weaker than one between black and white: v 275 / (v + 20), v the stretched level.
GreyPicture relit(ImageView<const std::uint8_t> grey, GreyRange range);

/// Means of 2 x 2 blocks: pixel x of the result lies at 2 x + 0.5 of the source.
GreyPicture halve(ImageView<const std::uint8_t> grey);

} // namespace dicot::calibration
