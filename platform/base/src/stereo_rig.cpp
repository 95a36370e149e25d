#include "dicot/base/stereo_rig.h"

#include <cmath>

namespace dicot {

namespace {

/// The distorted direction and how it grows with the undistorted one.
struct Bent
{
    Point2 at;
    double xx, xy, yy; // derivatives; the matrix is symmetric
};

Bent bend(const Lens& lens, Point2 d) noexcept
{
    const auto& [k1, k2, p1, p2, k3] = lens.k;
    const double r2 = d.x * d.x + d.y * d.y;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double slope = k1 + r2 * (2 * k2 + 3 * k3 * r2);
    return {{d.x * radial + 2 * p1 * d.x * d.y + p2 * (r2 + 2 * d.x * d.x),
             d.y * radial + p1 * (r2 + 2 * d.y * d.y) + 2 * p2 * d.x * d.y},
            radial + 2 * d.x * d.x * slope + 2 * p1 * d.y + 6 * p2 * d.x,
            2 * d.x * d.y * slope + 2 * p1 * d.x + 2 * p2 * d.y,
            radial + 2 * d.y * d.y * slope + 6 * p1 * d.y + 2 * p2 * d.x};
}

} // namespace

Point2 project(const Lens& lens, const Point3& point) noexcept
{
    const Point2 bent = bend(lens, {point.x / point.z, point.y / point.z}).at;
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
        const double determinant = bent.xx * bent.yy - bent.xy * bent.xy;
        if (!(bent.xx > 0 && determinant > 0))
            return std::nullopt; // past the circle where the distortion folds back
        d.x += (bent.yy * miss.x - bent.xy * miss.y) / determinant;
        d.y += (bent.xx * miss.y - bent.xy * miss.x) / determinant;
        if (miss.x * miss.x + miss.y * miss.y < 1e-26)
            return d;
    }
    return std::nullopt;
}

Point3 turned(const Turn& t, const Point3& p) noexcept
{
    return {t[0] * p.x + t[1] * p.y + t[2] * p.z, t[3] * p.x + t[4] * p.y + t[5] * p.z,
            t[6] * p.x + t[7] * p.y + t[8] * p.z};
}

Turn transposed(const Turn& t) noexcept
{
    return {t[0], t[3], t[6], t[1], t[4], t[7], t[2], t[5], t[8]};
}

Turn product(const Turn& a, const Turn& b) noexcept
{
    Turn c{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t col = 0; col < 3; ++col)
            c[3 * row + col] = a[3 * row] * b[col] + a[3 * row + 1] * b[3 + col] + a[3 * row + 2] * b[6 + col];
    return c;
}

double StereoRig::baseline_mm() const noexcept
{
    return std::sqrt(shift_mm.x * shift_mm.x + shift_mm.y * shift_mm.y + shift_mm.z * shift_mm.z);
}

Point3 StereoRig::into_right(const Point3& p) const noexcept
{
    const Point3 q = turned(turn, p);
    return {q.x + shift_mm.x, q.y + shift_mm.y, q.z + shift_mm.z};
}

} // namespace dicot
