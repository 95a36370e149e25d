#include "dicot/base/stereo_rig.h"

#include <cmath>

namespace dicot {

Point2 project(const Lens& lens, const Point3& point) noexcept
{
    return pixel_of(lens, {point.x / point.z, point.y / point.z});
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
