#include "dicot/calibration/camera.h"

#include <cmath>

namespace dicot::calibration {

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
