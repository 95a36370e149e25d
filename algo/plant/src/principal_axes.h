// Along which directions points are spread.
#pragma once

#include "vec3.h"

namespace dicot {

/// Sums over weighted points, about the first of them, so that nothing cancels.
class Moments
{
public:
    void add(Vec3 point, double weight)
    {
        if (weight_ == 0)
            origin_ = point;
        const Vec3 p = point - origin_;
        weight_ += weight;
        sum_ = sum_ + weight * p;
        xx_ += weight * p.x * p.x;
        xy_ += weight * p.x * p.y;
        xz_ += weight * p.x * p.z;
        yy_ += weight * p.y * p.y;
        yz_ += weight * p.y * p.z;
        zz_ += weight * p.z * p.z;
    }
    Vec3 mean() const { return origin_ + (1 / weight_) * sum_; }
    /// xx, xy, xz, yy, yz, zz about the mean
    void covariance(double (&c)[6]) const
    {
        const Vec3 m = (1 / weight_) * sum_;
        c[0] = xx_ / weight_ - m.x * m.x;
        c[1] = xy_ / weight_ - m.x * m.y;
        c[2] = xz_ / weight_ - m.x * m.z;
        c[3] = yy_ / weight_ - m.y * m.y;
        c[4] = yz_ / weight_ - m.y * m.z;
        c[5] = zz_ / weight_ - m.z * m.z;
    }

private:
    Vec3 origin_, sum_;
    double weight_ = 0, xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
};

struct PrincipalAxes
{
    Vec3 axis[3];       ///< unit, right-handed, by falling variance
    double variance[3]; ///< mm2
};

/// By Jacobi's rotations.
PrincipalAxes principal_axes(const Moments& moments);

} // namespace dicot
