#include "dicot/rectification/lens_map.h"

#include <cmath>

namespace dicot {
namespace {

constexpr double kWidestRadius = 8.0; // 83 degrees off the axis
constexpr double kFar = 1e6;          // px

double radial(const CameraModel& camera, double r2)
{
    const auto& k = camera.distortion;
    return (1 + ((k[4] * r2 + k[1]) * r2 + k[0]) * r2) / (1 + ((k[7] * r2 + k[6]) * r2 + k[5]) * r2);
}

/// The tangential and thin-prism part.
Position shift(const CameraModel& camera, Position at)
{
    const auto& k = camera.distortion;
    const double xx = at.x * at.x, xy = at.x * at.y, yy = at.y * at.y, r2 = xx + yy;
    return {2 * k[2] * xy + k[3] * (r2 + 2 * xx) + (k[8] + k[9] * r2) * r2,
            k[2] * (r2 + 2 * yy) + 2 * k[3] * xy + (k[10] + k[11] * r2) * r2};
}

Position distorted(const CameraModel& camera, Position at)
{
    const double scale = radial(camera, at.x * at.x + at.y * at.y);
    const Position off = shift(camera, at);
    return {at.x * scale + off.x, at.y * scale + off.y};
}

double fold_radius(const CameraModel& camera)
{
    constexpr double kStep = 1.0 / 256;
    double before = 0;
    for (int i = 1; i * kStep <= kWidestRadius; ++i) {
        const double r = i * kStep;
        const double now = r * radial(camera, r * r);
        if (!(now > before))
            return r - kStep;
        before = now;
    }
    return kWidestRadius;
}

} // namespace

LensMap::LensMap(const CameraModel& camera, const Matrix3& rectifying, double focal_px, double cx_px, double cy_px)
    : camera_(camera), camera_from_rectified_{rectifying[0], rectifying[3], rectifying[6], rectifying[1], rectifying[4],
                                              rectifying[7], rectifying[2], rectifying[5], rectifying[8]},
      focal_px_(focal_px), cx_px_(cx_px), cy_px_(cy_px), fold_radius_(fold_radius(camera))
{
}

Position LensMap::source_of(double x, double y) const
{
    const Matrix3& m = camera_from_rectified_;
    const double u = (x - cx_px_) / focal_px_;
    const double v = (y - cy_px_) / focal_px_;
    const double z = m[6] * u + m[7] * v + m[8];
    if (!(z > 0.05)) // beside or behind the camera
        return {-kFar, -kFar};
    Position at{(m[0] * u + m[1] * v + m[2]) / z, (m[3] * u + m[4] * v + m[5]) / z};
    Position beyond;
    const double r2 = at.x * at.x + at.y * at.y;
    if (r2 > fold_radius_ * fold_radius_) {
        const double held = fold_radius_ / std::sqrt(r2);
        beyond = {at.x * (1 - held), at.y * (1 - held)};
        at = {at.x * held, at.y * held};
    }
    const Position seen = distorted(camera_, at);
    return {camera_.fx * (seen.x + beyond.x) + camera_.cx, camera_.fy * (seen.y + beyond.y) + camera_.cy};
}

std::optional<Position> direction_of(const CameraModel& camera, Position pixel)
{
    constexpr int kMostSteps = 500;
    constexpr double kExactPx = 1e-9;
    const Position seen{(pixel.x - camera.cx) / camera.fx, (pixel.y - camera.cy) / camera.fy};
    Position at = seen;
    for (int step = 0; step < kMostSteps; ++step) {
        const Position back = distorted(camera, at);
        const double error = std::fabs(back.x - seen.x) * camera.fx + std::fabs(back.y - seen.y) * camera.fy;
        if (error < kExactPx)
            return at;
        const double scale = radial(camera, at.x * at.x + at.y * at.y);
        const Position off = shift(camera, at);
        at = {(seen.x - off.x) / scale, (seen.y - off.y) / scale};
        if (!(std::fabs(at.x) + std::fabs(at.y) < kWidestRadius))
            return std::nullopt;
    }
    return std::nullopt;
}

} // namespace dicot
