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

constexpr int kSamples = 3000;    ///< of the points, evenly
constexpr int kTries = 500;       ///< with half of the points on the plane one in eight hits it
constexpr double kDown = 0.4226;  ///< cos 65 degrees: from the camera's down direction
constexpr double kAhead = 0.8192; ///< cos 35 degrees: from the camera's axis, where cameras look straight down
constexpr double kNearPx = 6;     ///< how far a point of the plane may be off: as much depth as 6 px are wide
constexpr double kClearlyPx = 4 * kNearPx;
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

/// Which planes are looked for.
using Lies = bool (*)(const InversePlane&);

bool lies_below(const InversePlane& plane)
{
    const double size = length(plane);
    return size > 0 && plane.y >= kDown * size;
}

bool lies_ahead(const InversePlane& plane)
{
    const double size = length(plane);
    return size > 0 && plane.z >= kAhead * size;
}

struct Samples
{
    std::span<Vec3> points;
    double focal_px;
};

int score(const Samples& samples, const InversePlane& plane)
{
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
InversePlane best_of_tries(const Samples& samples, Lies lies)
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
        if (!lies(plane))
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
InversePlane refitted(const Samples& samples, const InversePlane& plane, Lies lies)
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
    return lies(fitted) ? fitted : plane;
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

/// Share of the samples clearly before the plane, in the tenth of the picture's rows that `row` names.
double before_in_tenth(const Samples& samples, const InversePlane& plane, double top, double bottom, int tenth)
{
    int all = 0, before = 0;
    for (const Vec3& p : samples.points) {
        const double row = (p.y / p.z - top) / (bottom - top) * 10;
        if (!(row >= tenth && row <= tenth + 1))
            continue;
        ++all;
        before += beyond_px(plane, p, samples.focal_px) < -kClearlyPx;
    }
    return all > 0 ? double(before) / all : 1;
}

/// A plane ahead is the ground for a camera that looks straight down, and a wall for one that looks level. Before a
/// wall, everything stands on something at the picture's lower edge and nothing needs to reach the upper one.
bool is_no_wall(const Samples& samples, const InversePlane& plane)
{
    double top = HUGE_VAL, bottom = -HUGE_VAL;
    for (const Vec3& p : samples.points) {
        top = std::min(top, p.y / p.z);
        bottom = std::max(bottom, p.y / p.z);
    }
    return before_in_tenth(samples, plane, top, bottom, 9) <=
           0.1 + 1.5 * before_in_tenth(samples, plane, top, bottom, 0);
}

struct Found
{
    InversePlane plane;
    Leftover left;
    bool ok = false;
};

Found find_plane(const Samples& samples, Lies lies)
{
    Found found{best_of_tries(samples, lies), {}, false};
    if (!lies(found.plane))
        return found;
    for (int round = 0; round < 3; ++round)
        found.plane = refitted(samples, found.plane, lies);
    found.left = leftover(samples, found.plane);
    found.ok = double(found.left.count) >= kLeastShare * double(samples.points.size());
    return found;
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

    Found found = find_plane(samples, lies_below);
    const bool below = found.ok;
    if (!below) {
        found = find_plane(samples, lies_ahead);
        found.ok = found.ok && is_no_wall(samples, found.plane);
    }
    if (found.ok) {
        const double size = length(found.plane);
        const Vec3 up = (-1 / size) * found.plane;
        // Where the camera looks, or, seen from straight above, where its picture's upper edge lies.
        const Vec3 forward = below ? Vec3{0, 0, 1} : Vec3{0, -1, 0};
        const Vec3 away = unit(forward - dot(forward, up) * up);
        ground.kind = GroundFrame::Kind::kBench;
        put((1 / (size * size)) * found.plane, ground.origin_mm);
        put(cross(away, up), ground.right);
        put(away, ground.away);
        put(up, ground.up);
        ground.rms_mm = found.left.rms_mm;
        ground.height_sd_mm = found.left.patches_rms_mm;
    }
    arena.rewind(mark);
    return ground;
}

} // namespace dicot
