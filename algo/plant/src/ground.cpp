#include "dicot/plant/canopy.h"
#include "frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace dicot {
namespace {

/// A plane as m p = 1, p in mm of the camera. Of a pixel it says 1 / z = m (x/z, y/z, 1), and noise of disparities is
/// alike in 1 / z everywhere: what is linear here is fitted here.
using InversePlane = Vec3;

constexpr int kSamples = 3000;   ///< of the points, evenly
constexpr int kTries = 500;      ///< with half of the points on the plane one in eight hits it
constexpr double kDown = 0.4226; ///< cos 65 degrees
constexpr double kNearPx = 6;    ///< how far a point of the plane may be off: as much depth as 6 px are wide
constexpr double kLeastShare = 0.1;

/// Depth by which p lies off the plane, in widths of a pixel there; positive where it lies beyond.
double beyond_px(const InversePlane& plane, const Vec3& p, double focal_px)
{
    return (dot(plane, p) - 1) * focal_px;
}

double determinant(const Vec3& a, const Vec3& b, const Vec3& c)
{
    return dot(a, cross(b, c));
}

/// Solves rows[i] m = right[i] for m; a null vector where they do not tell.
Vec3 solved(const Vec3 (&rows)[3], const Vec3& right)
{
    const double all = determinant(rows[0], rows[1], rows[2]);
    if (!(std::fabs(all) > 0))
        return {};
    return (1 / all) *
           (right.x * cross(rows[1], rows[2]) + right.y * cross(rows[2], rows[0]) + right.z * cross(rows[0], rows[1]));
}

bool lies_below(const InversePlane& plane)
{
    const double size = length(plane);
    return size > 0 && plane.y >= kDown * size;
}

struct Samples
{
    std::span<Vec3> points;
    double focal_px;
};

int score(const Samples& samples, const InversePlane& plane)
{
    constexpr double kClearlyPx = 4 * kNearPx;
    int on = 0;
    for (const Vec3& p : samples.points) {
        const double off = beyond_px(plane, p, samples.focal_px);
        if (std::fabs(off) < kNearPx)
            ++on;
        else if (off > kClearlyPx)
            --on;
    }
    return on;
}

/// Fischler and Bolles 1981, with the same tries on every machine.
InversePlane best_of_tries(const Samples& samples)
{
    std::uint32_t state = 1;
    const auto next = [&state, n = static_cast<std::uint32_t>(samples.points.size())] {
        state = state * 1664525u + 1013904223u; // Numerical Recipes
        return static_cast<std::size_t>((state >> 8) % n);
    };
    InversePlane best;
    int most = 0;
    for (int i = 0; i < kTries; ++i) {
        const Vec3 rows[3] = {samples.points[next()], samples.points[next()], samples.points[next()]};
        const InversePlane plane = solved(rows, {1, 1, 1});
        if (!lies_below(plane))
            continue;
        const int on = score(samples, plane);
        if (on > most) {
            most = on;
            best = plane;
        }
    }
    return best;
}

/// Least squares in 1 / z over the points near `plane`.
InversePlane refitted(const Samples& samples, const InversePlane& plane)
{
    Vec3 rows[3] = {};
    Vec3 right;
    for (const Vec3& p : samples.points) {
        if (!(std::fabs(beyond_px(plane, p, samples.focal_px)) < kNearPx))
            continue;
        const Vec3 direction = (1 / p.z) * p;
        rows[0] = rows[0] + direction.x * direction;
        rows[1] = rows[1] + direction.y * direction;
        rows[2] = rows[2] + direction;
        right = right + (1 / p.z) * direction;
    }
    const InversePlane fitted = solved(rows, right);
    return lies_below(fitted) ? fitted : plane;
}

/// What a plane leaves over patches of neighbouring samples is not noise of single points.
struct Leftover
{
    double rms_mm = 0, patches_rms_mm = 0;
    std::size_t count = 0;
};

Leftover leftover(const Samples& samples, const InversePlane& plane)
{
    constexpr int kPatch = 25;
    Leftover left;
    double all = 0, patches = 0, patch = 0;
    int in_patch = 0, patch_count = 0;
    for (const Vec3& p : samples.points) {
        if (!(std::fabs(beyond_px(plane, p, samples.focal_px)) < kNearPx))
            continue;
        const double off = (1 - dot(plane, p)) / length(plane);
        all += off * off;
        ++left.count;
        patch += off;
        if (++in_patch == kPatch) {
            patches += patch / kPatch * (patch / kPatch);
            ++patch_count;
            in_patch = 0;
            patch = 0;
        }
    }
    left.rms_mm = left.count > 0 ? std::sqrt(all / double(left.count)) : 0;
    left.patches_rms_mm = patch_count > 0 ? std::sqrt(patches / patch_count) : 0;
    return left;
}

void put(const Vec3& from, double (&to)[3])
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

} // namespace

GroundFrame find_ground(const PlantView& view, Arena& arena)
{
    GroundFrame ground;
    const std::size_t mark = arena.used();
    const std::size_t count = std::min(view.cloud.points.size(), std::size_t{kSamples});
    const Samples samples{arena.take<Vec3>(count), view.focal_px};
    if (arena.overrun() || count < 3)
        return ground;
    for (std::size_t i = 0; i < count; ++i)
        samples.points[i] = point_mm(view, i * view.cloud.points.size() / count);

    InversePlane plane = best_of_tries(samples);
    if (lies_below(plane)) {
        for (int round = 0; round < 3; ++round)
            plane = refitted(samples, plane);
        const Leftover left = leftover(samples, plane);
        if (double(left.count) >= kLeastShare * double(count)) {
            const double size = length(plane);
            const Vec3 up = (-1 / size) * plane;
            const Vec3 forward{0, 0, 1};
            const Vec3 away = unit(forward - dot(forward, up) * up);
            ground.kind = GroundFrame::Kind::kBench;
            put((1 / (size * size)) * plane, ground.origin_mm);
            put(cross(away, up), ground.right);
            put(away, ground.away);
            put(up, ground.up);
            ground.rms_mm = left.rms_mm;
            ground.height_sd_mm = left.patches_rms_mm;
        }
    }
    arena.rewind(mark);
    return ground;
}

} // namespace dicot
