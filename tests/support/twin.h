// The paper's equations in double precision, written to be read: slow, and sharing nothing with the matcher.
#pragma once

#include "dicot/base/image.h"

#include <vector>

namespace dicot::twin {

struct Settings
{
    int disparities = 64;
    int radius = 17;
    double gamma_color = 6;
    double gamma_space = 17;
    double alpha_census = 5;
    double alpha_difference = 15;
};

/// One row of winners (eq. 14) and their sub-pixel disparities (eq. 15), px.
struct Row
{
    std::vector<int> winner;
    std::vector<double> disparity;
};

/// A pair prepared for matching: CIELAB colours and censuses.
class Pair
{
public:
    Pair(ImageView<const Rgb8> left, ImageView<const Rgb8> right, const Settings& settings);
    /// Eq. 6 to 15 for row y.
    Row match_row(int y) const;

private:
    struct Pixel
    {
        double l, a, b;
        double channel[3];
        unsigned census;
    };
    using Picture = std::vector<Pixel>;

    Picture prepare(ImageView<const Rgb8> picture) const;
    const Pixel& at(const Picture& picture, int x, int y) const
    {
        return picture[static_cast<std::size_t>(y * width_ + x)];
    }
    double cost(int x, int y, int d) const;                                      // eq. 10 to 12
    double weight(const Picture& picture, int px, int py, int qx, int qy) const; // eq. 6 to 8

    Settings settings_;
    int width_, height_;
    Picture left_, right_;
};

} // namespace dicot::twin
