#include "dicot/calibration/camera.h"

#include <cmath>

namespace dicot::calibration {

namespace {

/// The distorted direction and how it grows with the undistorted one.
struct Bent
{
    Point2 at;
    double xx, xy, yy; // derivatives; the matrix is symmetric
};

Bent bend(const Lens& lens, Point2 d)
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

Point2 project(const Lens& lens, const Point3& point)
{
    const Point2 bent = bend(lens, {point.x / point.z, point.y / point.z}).at;
    return {lens.fx * bent.x + lens.cx, lens.fy * bent.y + lens.cy};
}

std::optional<Point2> undistort(const Lens& lens, Point2 pixel)
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

double StereoRig::baseline_mm() const
{
    return std::sqrt(shift_mm.x * shift_mm.x + shift_mm.y * shift_mm.y + shift_mm.z * shift_mm.z);
}

Point3 StereoRig::into_right(const Point3& p) const
{
    return {turn[0] * p.x + turn[1] * p.y + turn[2] * p.z + shift_mm.x,
            turn[3] * p.x + turn[4] * p.y + turn[5] * p.z + shift_mm.y,
            turn[6] * p.x + turn[7] * p.y + turn[8] * p.z + shift_mm.z};
}

std::optional<Point3> triangulate(const StereoRig& rig, Point2 left, Point2 right)
{
    // z_left (turn l) + shift = z_right r, least squares in the two distances.
    const Point3 l{rig.turn[0] * left.x + rig.turn[1] * left.y + rig.turn[2],
                   rig.turn[3] * left.x + rig.turn[4] * left.y + rig.turn[5],
                   rig.turn[6] * left.x + rig.turn[7] * left.y + rig.turn[8]};
    const Point3& s = rig.shift_mm;
    const double ll = l.x * l.x + l.y * l.y + l.z * l.z;
    const double rr = right.x * right.x + right.y * right.y + 1;
    const double lr = l.x * right.x + l.y * right.y + l.z;
    const double ls = l.x * s.x + l.y * s.y + l.z * s.z;
    const double rs = right.x * s.x + right.y * s.y + s.z;
    const double determinant = ll * rr - lr * lr;
    if (!(determinant > 1e-15 * ll * rr))
        return std::nullopt;
    const double z_left = (lr * rs - rr * ls) / determinant;
    const double z_right = (ll * rs - lr * ls) / determinant;
    // The middle of the connection, brought back into the left frame.
    const Point3 gap{z_right * right.x - z_left * l.x - s.x, z_right * right.y - z_left * l.y - s.y,
                     z_right - z_left * l.z - s.z};
    const Turn& m = rig.turn;
    return Point3{z_left * left.x + 0.5 * (m[0] * gap.x + m[3] * gap.y + m[6] * gap.z),
                  z_left * left.y + 0.5 * (m[1] * gap.x + m[4] * gap.y + m[7] * gap.z),
                  z_left + 0.5 * (m[2] * gap.x + m[5] * gap.y + m[8] * gap.z)};
}

std::optional<double> epipolar_distance_px(const StereoRig& rig, Point2 left, Point2 right)
{
    const std::optional<Point2> l = undistort(rig.left, left);
    const std::optional<Point2> r = undistort(rig.right, right);
    if (!l || !r)
        return std::nullopt;
    const Point3& s = rig.shift_mm;
    const Turn& m = rig.turn;
    // Essential matrix: skew(shift) turn; lines are scaled by the focal lengths to speak of pixels.
    const Point3 turned{m[0] * l->x + m[1] * l->y + m[2], m[3] * l->x + m[4] * l->y + m[5],
                        m[6] * l->x + m[7] * l->y + m[8]};
    const Point3 line_right{s.y * turned.z - s.z * turned.y, s.z * turned.x - s.x * turned.z,
                            s.x * turned.y - s.y * turned.x};
    const double miss = line_right.x * r->x + line_right.y * r->y + line_right.z;
    const Point3 crossed{r->y * s.z - s.y, s.x - r->x * s.z, r->x * s.y - r->y * s.x};
    const Point2 line_left{m[0] * crossed.x + m[3] * crossed.y + m[6] * crossed.z,
                           m[1] * crossed.x + m[4] * crossed.y + m[7] * crossed.z};
    const auto in_px = [&](double x, double y, const Lens& lens) {
        return std::abs(miss) / std::sqrt(x * x / (lens.fx * lens.fx) + y * y / (lens.fy * lens.fy));
    };
    return 0.5 * (in_px(line_right.x, line_right.y, rig.right) + in_px(line_left.x, line_left.y, rig.left));
}

} // namespace dicot::calibration
