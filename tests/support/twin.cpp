#include "twin.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace dicot::twin {
namespace {

double linear(double c)
{
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double f(double t)
{
    return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

double rho(double c, double alpha)
{
    return 1.0 - std::exp(-c / alpha);
} // eq. 12

} // namespace

Pair::Pair(ImageView<const Rgb8> left, ImageView<const Rgb8> right, const Settings& settings)
    : settings_(settings), width_(left.width), height_(left.height), left_(prepare(left)), right_(prepare(right))
{
}

Pair::Picture Pair::prepare(ImageView<const Rgb8> picture) const
{
    Picture prepared;
    const auto grey = [&](int x, int y) {
        const Rgb8 p = picture.at(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1));
        return (77 * p.r + 150 * p.g + 29 * p.b) / 256;
    };
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            const Rgb8 p = picture.at(x, y);
            const double r = linear(p.r / 255.0);
            const double g = linear(p.g / 255.0);
            const double b = linear(p.b / 255.0);
            const double fx = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
            const double fy = f(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
            const double fz = f((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
            unsigned census = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    if (dx != 0 || dy != 0)
                        census = census * 2 + (grey(x + dx, y + dy) < grey(x, y));
            prepared.push_back(
                {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz), {double(p.r), double(p.g), double(p.b)}, census});
        }
    }
    return prepared;
}

double Pair::cost(int x, int y, int d) const
{
    const Pixel& p = at(left_, x, y);
    const Pixel& q = at(right_, x - d, y);
    double difference = 0; // eq. 10: the mean over the channels
    for (int c = 0; c < 3; ++c)
        difference += std::abs(p.channel[c] - q.channel[c]) / 3;
    const int hamming = std::popcount(p.census ^ q.census); // eq. 11
    return rho(hamming, settings_.alpha_census) + rho(difference, settings_.alpha_difference);
}

double Pair::weight(const Picture& picture, int px, int py, int qx, int qy) const
{
    const Pixel& p = at(picture, px, py);
    const Pixel& q = at(picture, qx, qy);
    const double colour = std::sqrt((p.l - q.l) * (p.l - q.l) + (p.a - q.a) * (p.a - q.a) + (p.b - q.b) * (p.b - q.b));
    const double space = std::sqrt(double((px - qx) * (px - qx) + (py - qy) * (py - qy)));
    return std::exp(-(colour / settings_.gamma_color + space / settings_.gamma_space));
}

Row Pair::match_row(int y) const
{
    const int radius = settings_.radius;
    const int top = std::max(y - radius, 0);
    const int bottom = std::min(y + radius, height_ - 1);
    const int side = 2 * radius + 1;
    const auto cell = [&](int x, int dx, int row) {
        return (static_cast<std::size_t>(x) * static_cast<std::size_t>(side) + static_cast<std::size_t>(row - top)) *
                   static_cast<std::size_t>(side) +
               static_cast<std::size_t>(dx + radius);
    };

    // The weights of every pixel of the row, and the costs of every pixel that lies in one of its windows.
    std::vector<double> left_weight(cell(width_, -radius, top), 0.0);
    std::vector<double> right_weight = left_weight;
    for (int x = 0; x < width_; ++x) {
        for (int row = top; row <= bottom; ++row) {
            for (int dx = std::max(-radius, -x); dx <= std::min(radius, width_ - 1 - x); ++dx) {
                left_weight[cell(x, dx, row)] = weight(left_, x, y, x + dx, row);
                right_weight[cell(x, dx, row)] = weight(right_, x, y, x + dx, row);
            }
        }
    }
    const auto cost_cell = [&](int d, int x, int row) {
        return (static_cast<std::size_t>(d) * static_cast<std::size_t>(side) + static_cast<std::size_t>(row - top)) *
                   static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    };
    std::vector<double> costs(cost_cell(settings_.disparities, 0, top), 0.0);
    for (int d = 0; d < settings_.disparities; ++d)
        for (int row = top; row <= bottom; ++row)
            for (int x = d; x < width_; ++x)
                costs[cost_cell(d, x, row)] = cost(x, row, d);

    Row result;
    for (int x = 0; x < width_; ++x) {
        std::vector<double> aggregated; // eq. 13
        for (int d = 0; d < settings_.disparities && d <= x; ++d) {
            double numerator = 0;
            double denominator = 0;
            const int first = std::max(-radius, d - x);
            const int last = std::min(radius, width_ - 1 - x);
            for (int row = top; row <= bottom; ++row) {
                for (int dx = first; dx <= last; ++dx) {
                    const double w = left_weight[cell(x, dx, row)] * right_weight[cell(x - d, dx, row)];
                    numerator += w * costs[cost_cell(d, x + dx, row)];
                    denominator += w;
                }
            }
            aggregated.push_back(numerator / denominator);
        }
        const auto least = std::min_element(aggregated.begin(), aggregated.end()); // eq. 14
        const int d = static_cast<int>(least - aggregated.begin());
        double offset = 0; // eq. 15
        if (d > 0 && d + 1 < static_cast<int>(aggregated.size())) {
            const double curvature = least[-1] - 2 * least[0] + least[1];
            if (curvature > 0)
                offset = (least[-1] - least[1]) / (2 * curvature);
        }
        result.winner.push_back(d);
        result.disparity.push_back(d + offset);
    }
    return result;
}

} // namespace dicot::twin
