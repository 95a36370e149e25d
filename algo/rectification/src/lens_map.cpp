#include "dicot/rectification/lens_map.h"

#include <cmath>

namespace dicot {
namespace {

constexpr double kWidestRadius = 8.0; // 83 degrees off the axis
constexpr double kFar = 1e6;          // px

double fold_radius(const Lens& lens)
{
    constexpr double kStep = 1.0 / 256;
    double before = 0;
    for (int i = 1; i * kStep <= kWidestRadius; ++i) {
        const double r = i * kStep;
        const double now = r * radial_scale(lens, r * r);
        if (!(now > before))
            return r - kStep;
        before = now;
    }
    return kWidestRadius;
}

} // namespace

LensMap::LensMap(const Lens& lens, const Turn& rectifying, double focal_px, double cx_px, double cy_px)
    : lens_(lens), camera_from_rectified_{rectifying[0], rectifying[3], rectifying[6], rectifying[1], rectifying[4],
                                          rectifying[7], rectifying[2], rectifying[5], rectifying[8]},
      focal_px_(focal_px), cx_px_(cx_px), cy_px_(cy_px), fold_radius_(fold_radius(lens))
{
}

Point2 LensMap::source_of(double x, double y) const
{
    const Turn& m = camera_from_rectified_;
    const double u = (x - cx_px_) / focal_px_;
    const double v = (y - cy_px_) / focal_px_;
    const double z = m[6] * u + m[7] * v + m[8];
    if (!(z > 0.05)) // beside or behind the camera
        return {-kFar, -kFar};
    Point2 at{(m[0] * u + m[1] * v + m[2]) / z, (m[3] * u + m[4] * v + m[5]) / z};
    Point2 beyond;
    const double r2 = at.x * at.x + at.y * at.y;
    if (r2 > fold_radius_ * fold_radius_) {
        const double held = fold_radius_ / std::sqrt(r2);
        beyond = {at.x * (1 - held), at.y * (1 - held)};
        at = {at.x * held, at.y * held};
    }
    const Point2 seen = distort(lens_, at);
    return {lens_.fx * (seen.x + beyond.x) + lens_.cx, lens_.fy * (seen.y + beyond.y) + lens_.cy};
}

} // namespace dicot
