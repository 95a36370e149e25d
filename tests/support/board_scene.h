// A chessboard before a camera: where its corners fall, and what the camera sees. Written apart from the product.
#pragma once

#include "dicot/calibration/board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace dicot::test {

using calibration::Board;

inline Turn times(const Turn& a, const Turn& b)
{
    Turn m{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k)
                m[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return m;
}

/// Turned about x, then y, then z.
inline Turn turn_about(double x_deg, double y_deg, double z_deg)
{
    const auto c = [](double deg) { return std::cos(deg * std::numbers::pi / 180); };
    const auto s = [](double deg) { return std::sin(deg * std::numbers::pi / 180); };
    const Turn x{1, 0, 0, 0, c(x_deg), -s(x_deg), 0, s(x_deg), c(x_deg)};
    const Turn y{c(y_deg), 0, s(y_deg), 0, 1, 0, -s(y_deg), 0, c(y_deg)};
    const Turn z{c(z_deg), -s(z_deg), 0, s(z_deg), c(z_deg), 0, 0, 0, 1};
    return times(z, times(y, x));
}

struct Placement
{
    Turn turn{1, 0, 0, 0, 1, 0, 0, 0, 1};
    Point3 shift_mm;

    Point3 operator()(const Point3& p) const
    {
        return {turn[0] * p.x + turn[1] * p.y + turn[2] * p.z + shift_mm.x,
                turn[3] * p.x + turn[4] * p.y + turn[5] * p.z + shift_mm.y,
                turn[6] * p.x + turn[7] * p.y + turn[8] * p.z + shift_mm.z};
    }
};

/// The formulas of OpenCV's documentation, term by term.
inline Point2 reference_project(const Lens& lens, const Point3& p)
{
    const double x = p.x / p.z;
    const double y = p.y / p.z;
    const double r2 = x * x + y * y;
    const double k1 = lens.k[0], k2 = lens.k[1], p1 = lens.k[2], p2 = lens.k[3], k3 = lens.k[4];
    const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
    const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
    const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
    return {lens.fx * xd + lens.cx, lens.fy * yd + lens.cy};
}

/// Corners row after row; the board's origin is its middle, its z axis points away from the camera.
inline std::vector<Point3> board_points(const Board& board, const Placement& place)
{
    std::vector<Point3> points;
    for (int row = 0; row < board.rows; ++row)
        for (int col = 0; col < board.cols; ++col)
            points.push_back(place({board.square_mm * (col - 0.5 * (board.cols - 1)),
                                    board.square_mm * (row - 0.5 * (board.rows - 1)), 0}));
    return points;
}

inline std::vector<Point2> board_corners(const Board& board, const Placement& place, const Lens& lens)
{
    std::vector<Point2> corners;
    for (const Point3& p : board_points(board, place))
        corners.push_back(reference_project(lens, p));
    return corners;
}

struct Scene
{
    Board board{9, 6, 30};
    Placement place{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 600}};
    Lens lens{600, 600, 319.5, 239.5, {}};
    int width = 640;
    int height = 480;
    double white = 210;
    double black = 25;
    double background = 110;
    double margin_mm = 20; ///< white rim around the squares
    double blur_px = 0.7;
    double noise = 2;     ///< standard deviation in grey levels
    double dark_part = 1; ///< light in the left third of the picture, against the rest; the border is soft
    double shadow = 1;    ///< light below a slanting line, against the rest; the edge is as sharp as the picture
    double light = 1;     ///< on everything, before the noise
    int spots = 0;        ///< of dirt, up to 3 px wide
    double glare = 0;     ///< grey levels added in the middle of a soft spot
    Point2 glare_at{0, 0};
    double glare_px = 60; ///< radius of the spot
    std::uint32_t seed = 1;
};

struct Photo
{
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;
    ImageView<const std::uint8_t> view() const { return {pixels.data(), width, height}; }
};

inline double shade_of(const Scene& s, double x, double y)
{
    // The direction of the pixel by repeated substitution, then the plane of the board.
    const double xd = (x - s.lens.cx) / s.lens.fx;
    const double yd = (y - s.lens.cy) / s.lens.fy;
    double u = xd;
    double v = yd;
    const bool straight = std::all_of(s.lens.k.begin(), s.lens.k.end(), [](double k) { return k == 0; });
    for (int step = 0; step < (straight ? 0 : 12); ++step) {
        const double r2 = u * u + v * v;
        const double radial = 1 + r2 * (s.lens.k[0] + r2 * (s.lens.k[1] + r2 * s.lens.k[4]));
        const double du = 2 * s.lens.k[2] * u * v + s.lens.k[3] * (r2 + 2 * u * u);
        const double dv = s.lens.k[2] * (r2 + 2 * v * v) + 2 * s.lens.k[3] * u * v;
        u = (xd - du) / radial;
        v = (yd - dv) / radial;
    }
    const Turn& t = s.place.turn;
    const Point3& o = s.place.shift_mm;
    const double depth = (t[2] * o.x + t[5] * o.y + t[8] * o.z) / (t[2] * u + t[5] * v + t[8]);
    const Point3 d{depth * u - o.x, depth * v - o.y, depth - o.z};
    const double bx = t[0] * d.x + t[3] * d.y + t[6] * d.z;
    const double by = t[1] * d.x + t[4] * d.y + t[7] * d.z;
    const double half_x = 0.5 * (s.board.cols + 1) * s.board.square_mm;
    const double half_y = 0.5 * (s.board.rows + 1) * s.board.square_mm;
    if (depth <= 0 || std::abs(bx) > half_x + s.margin_mm || std::abs(by) > half_y + s.margin_mm)
        return s.background;
    if (std::abs(bx) > half_x || std::abs(by) > half_y)
        return s.white;
    const int col = static_cast<int>((bx + half_x) / s.board.square_mm);
    const int row = static_cast<int>((by + half_y) / s.board.square_mm);
    return (col + row) % 2 == 0 ? s.black : s.white;
}

/// The picture: 5 x 5 rays a pixel, each somewhere in its part, light, blur, noise, 8 bits.
inline Photo photograph(const Scene& s)
{
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(s.width) + static_cast<std::size_t>(x);
    };
    std::mt19937 random(s.seed);
    const auto jitter = [](std::mt19937& r) { return static_cast<double>(r()) / 4294967296.0; };
    std::vector<double> light(at(0, s.height));
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x) {
            double sum = 0;
            for (int k = 0; k < 25; ++k)
                sum += shade_of(s, x + (k % 5 + jitter(random)) / 5 - 0.5, y + (k / 5 + jitter(random)) / 5 - 0.5) / 25;
            sum *= s.dark_part + (1 - s.dark_part) / (1 + std::exp(-(x - s.width / 3.0) / 8));
            if (y > 0.3 * s.height + 0.35 * x)
                sum *= s.shadow;
            sum *= s.light;
            const double r2 = (x - s.glare_at.x) * (x - s.glare_at.x) + (y - s.glare_at.y) * (y - s.glare_at.y);
            light[at(x, y)] = sum + s.glare * std::exp(-0.5 * r2 / (s.glare_px * s.glare_px));
        }
    for (int k = 0; k < s.spots; ++k) {
        const int x = static_cast<int>(jitter(random) * (s.width - 3)),
                  y = static_cast<int>(jitter(random) * (s.height - 3));
        const double tone = 255 * jitter(random);
        for (int dy = 0; dy < 3; ++dy)
            std::fill_n(light.begin() + static_cast<std::ptrdiff_t>(at(x, y + dy)), 1 + k % 3, tone);
    }
    const int reach = static_cast<int>(std::ceil(3 * s.blur_px));
    std::vector<double> half(light.size());
    const auto blurred = [&](const std::vector<double>& from, int x, int y, int dx, int dy) {
        double sum = 0;
        double weights = 0;
        for (int k = -reach; k <= reach; ++k) {
            const double w = std::exp(-0.5 * k * k / (s.blur_px * s.blur_px + 1e-9));
            sum += w * from[at(std::clamp(x + k * dx, 0, s.width - 1), std::clamp(y + k * dy, 0, s.height - 1))];
            weights += w;
        }
        return sum / weights;
    };
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x)
            half[at(x, y)] = blurred(light, x, y, 1, 0);
    std::normal_distribution<double> noise(0, 1);
    Photo photo{s.width, s.height, {}};
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x)
            photo.pixels.push_back(static_cast<std::uint8_t>(
                std::clamp(blurred(half, x, y, 0, 1) + s.noise * noise(random) + 0.5, 0.0, 255.0)));
    return photo;
}

} // namespace dicot::test
