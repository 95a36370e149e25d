#include "pinhole.h"

#include <cmath>

namespace dicot::calibration {

Projection project_with_derivatives(const LensVector& lens, const Eigen::Vector3d& point)
{
    const double fx = lens[0], fy = lens[1], cx = lens[2], cy = lens[3];
    const double k1 = lens[4], k2 = lens[5], p1 = lens[6], p2 = lens[7], k3 = lens[8];
    const double iz = 1.0 / point.z();
    const double x = point.x() * iz;
    const double y = point.y() * iz;
    const double r2 = x * x + y * y;
    const double r4 = r2 * r2;
    const double r6 = r4 * r2;
    const double radial = 1 + k1 * r2 + k2 * r4 + k3 * r6;
    const double slope = k1 + 2 * k2 * r2 + 3 * k3 * r4; // of radial by r2
    const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
    const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
    const double xd_x = radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x;
    const double mixed = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y;
    const double yd_y = radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x;

    Projection p;
    p.pixel << fx * xd + cx, fy * yd + cy;
    Eigen::Matrix<double, 2, 2> by_direction;
    by_direction << fx * xd_x, fx * mixed, fy * mixed, fy * yd_y;
    Eigen::Matrix<double, 2, 3> direction_by_point;
    direction_by_point << iz, 0, -x * iz, 0, iz, -y * iz;
    p.by_point = by_direction * direction_by_point;
    p.by_lens << xd, 0, 1, 0, fx * x * r2, fx * x * r4, fx * 2 * x * y, fx * (r2 + 2 * x * x), fx * x * r6, //
        0, yd, 0, 1, fy * y * r2, fy * y * r4, fy * (r2 + 2 * y * y), fy * 2 * x * y, fy * y * r6;
    return p;
}

Pose Pose::moved(const Eigen::Matrix<double, 6, 1>& step) const
{
    // To first order the rotation by the vector; a proper rotation for any length, from products and a root alone.
    Eigen::Quaterniond small(1.0, 0.5 * step[0], 0.5 * step[1], 0.5 * step[2]);
    small.normalize();
    Pose p{small * turn, shift + step.tail<3>()};
    p.turn.normalize();
    return p;
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v)
{
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

LensVector lens_vector(const Lens& lens)
{
    LensVector v;
    v << lens.fx, lens.fy, lens.cx, lens.cy, lens.k[0], lens.k[1], lens.k[2], lens.k[3], lens.k[4];
    return v;
}

Lens lens_of(const LensVector& v)
{
    return {v[0], v[1], v[2], v[3], {v[4], v[5], v[6], v[7], v[8]}};
}

Turn turn_of(const Eigen::Quaterniond& q)
{
    const Eigen::Matrix3d m = q.toRotationMatrix();
    return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

Eigen::Quaterniond quaternion_of(const Turn& t)
{
    Eigen::Matrix3d m;
    m << t[0], t[1], t[2], t[3], t[4], t[5], t[6], t[7], t[8];
    return Eigen::Quaterniond(m).normalized();
}

} // namespace dicot::calibration
