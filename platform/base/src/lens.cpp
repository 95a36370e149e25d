#include "dicot/base/lens.h"

namespace dicot {
namespace {

/// A polynomial in r2 without its constant term, and its derivative.
struct Series
{
    double value, slope;
};

Series series(double a, double b, double c, double r2) noexcept
{
    return {r2 * (a + r2 * (b + r2 * c)), a + r2 * (2 * b + 3 * c * r2)};
}

/// The distorted direction and how it grows with the undistorted one.
struct Bent
{
    Point2 at;
    double xx, xy, yx, yy; // xy: of x with y
};

Bent bend(const Lens& lens, Point2 d) noexcept
{
    const auto& [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4] = lens.k;
    const double r2 = d.x * d.x + d.y * d.y;
    const Series above = series(k1, k2, k3, r2);
    const Series below = series(k4, k5, k6, r2);
    const double radial = (1 + above.value) / (1 + below.value);
    const double slope = 2 * (above.slope - radial * below.slope) / (1 + below.value); // for one step of x: slope x
    const double prism_x = 2 * (s1 + 2 * s2 * r2);
    const double prism_y = 2 * (s3 + 2 * s4 * r2);
    return {{d.x * radial + 2 * p1 * d.x * d.y + p2 * (r2 + 2 * d.x * d.x) + r2 * (s1 + s2 * r2),
             d.y * radial + p1 * (r2 + 2 * d.y * d.y) + 2 * p2 * d.x * d.y + r2 * (s3 + s4 * r2)},
            radial + d.x * d.x * slope + 2 * p1 * d.y + 6 * p2 * d.x + prism_x * d.x,
            d.x * d.y * slope + 2 * p1 * d.x + 2 * p2 * d.y + prism_x * d.y,
            d.x * d.y * slope + 2 * p1 * d.x + 2 * p2 * d.y + prism_y * d.x,
            radial + d.y * d.y * slope + 6 * p1 * d.y + 2 * p2 * d.x + prism_y * d.y};
}

} // namespace

double radial_scale(const Lens& lens, double r2) noexcept
{
    const auto& k = lens.k;
    return (1 + series(k[0], k[1], k[4], r2).value) / (1 + series(k[5], k[6], k[7], r2).value);
}

Point2 distort(const Lens& lens, Point2 direction) noexcept
{
    return bend(lens, direction).at;
}

Point2 pixel_of(const Lens& lens, Point2 direction) noexcept
{
    const Point2 bent = distort(lens, direction);
    return {lens.fx * bent.x + lens.cx, lens.fy * bent.y + lens.cy};
}

std::optional<Point2> undistort(const Lens& lens, Point2 pixel) noexcept
{
    const Point2 seen{(pixel.x - lens.cx) / lens.fx, (pixel.y - lens.cy) / lens.fy};
    Point2 d = seen;
    constexpr int kMaxSteps = 30;
    for (int step = 0; step < kMaxSteps; ++step) {
        const Bent bent = bend(lens, d);
        const Point2 miss{seen.x - bent.at.x, seen.y - bent.at.y};
        const double determinant = bent.xx * bent.yy - bent.xy * bent.yx;
        if (!(bent.xx > 0 && determinant > 0))
            return std::nullopt; // past the circle where the distortion folds back
        d.x += (bent.yy * miss.x - bent.xy * miss.y) / determinant;
        d.y += (bent.xx * miss.y - bent.yx * miss.x) / determinant;
        if (miss.x * miss.x + miss.y * miss.y < 1e-26)
            return d;
    }
    return std::nullopt;
}

} // namespace dicot
