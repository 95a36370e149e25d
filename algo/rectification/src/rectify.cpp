#include "dicot/rectification/rectify.h"

#include "dicot/rectification/lens_map.h"

#include <algorithm>
#include <cmath>

namespace dicot {
namespace {

constexpr double kShortestBaselineMm = 1.0;
constexpr double kOrthogonal = 1e-5; // what a text file's rounding may have done to a rotation

Turn rotation_of(double w, double x, double y, double z)
{
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    w /= length, x /= length, y /= length, z /= length;
    return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

/// Half of a turn by less than 90 degrees: of its quaternion (w, v), the one in the middle to the turn by nothing.
Turn half_of(const Turn& turn)
{
    const double w = std::sqrt(1 + turn[0] + turn[4] + turn[8]) / 2;
    return rotation_of(1 + w, (turn[7] - turn[5]) / (4 * w), (turn[2] - turn[6]) / (4 * w),
                       (turn[3] - turn[1]) / (4 * w));
}

/// The shortest turn that brings `from` onto the negative x axis.
Turn onto_minus_x(const Point3& from)
{
    const double length = std::sqrt(from.x * from.x + from.y * from.y + from.z * from.z);
    const Point3 unit{from.x / length, from.y / length, from.z / length};
    return rotation_of(1 - unit.x, 0, -unit.z, unit.y); // 1 + cosine, and unit x (-1, 0, 0)
}

bool finite(const StereoRig& rig)
{
    bool all = true;
    for (const Lens* lens : {&rig.left, &rig.right}) {
        for (const double value : {lens->fx, lens->fy, lens->cx, lens->cy})
            all = all && std::isfinite(value);
        all = all && std::ranges::all_of(lens->k, [](double k) { return std::isfinite(k); });
    }
    all = all && std::ranges::all_of(rig.turn, [](double r) { return std::isfinite(r); });
    return all && std::isfinite(rig.shift_mm.x) && std::isfinite(rig.shift_mm.y) && std::isfinite(rig.shift_mm.z);
}

bool is_rotation(const Turn& m)
{
    const Turn square = product(m, transposed(m));
    for (std::size_t i = 0; i < 9; ++i)
        if (std::fabs(square[i] - (i % 4 == 0 ? 1.0 : 0.0)) > kOrthogonal)
            return false;
    const double determinant =
        m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
    return determinant > 0;
}

Status check(const StereoRig& rig, const char* name)
{
    if (!finite(rig))
        return failure(Fault::kBadData, "%s: a number of the calibration is not finite: calibrate again", name);
    if (rig.width < 8 || rig.height < 8 || rig.width > 16384 || rig.height > 16384)
        return failure(Fault::kBadData,
                       "%s: pictures of %d x %d px cannot be rectified (8 to 16384 on a side): calibrate with the "
                       "cameras' real size",
                       name, rig.width, rig.height);
    for (const Lens* lens : {&rig.left, &rig.right})
        if (!(lens->fx > 1) || !(lens->fy > 1))
            return failure(Fault::kBadData, "%s: a focal length of %.6g x %.6g px is senseless: calibrate again", name,
                           lens->fx, lens->fy);
    if (!is_rotation(rig.turn))
        return failure(Fault::kBadData, "%s: R is no rotation: calibrate again", name);
    if (!(rig.turn[0] + rig.turn[4] + rig.turn[8] > 1))
        return failure(Fault::kBadData,
                       "%s: the cameras look in directions more than 90 degrees apart: calibrate again", name);
    const auto& t = rig.shift_mm;
    if (!(std::fabs(t.x) >= kShortestBaselineMm) && !(std::fabs(t.y) >= kShortestBaselineMm))
        return failure(Fault::kBadData,
                       "%s: the baseline is %.6g mm, too short for two cameras: if the file's lengths are metres, "
                       "add the line 'unit: m'",
                       name, std::fabs(t.x));
    return {};
}

/// What the pictures of one camera cover of the rectified plane at focal length 1, from points along the border.
struct Cover
{
    double mean_x = 0, mean_y = 0;                           ///< of the four corners
    double inner_left, inner_right, inner_top, inner_bottom; ///< inside of the border
    double outer_left, outer_right, outer_top, outer_bottom; ///< around it
};

Result<Cover> cover_of(const Lens& lens, const Turn& rectifying, int width, int height, const char* name)
{
    constexpr int kSteps = 64;
    Cover cover{0, 0, -1e9, 1e9, -1e9, 1e9, 1e9, -1e9, 1e9, -1e9};
    for (int side = 0; side < 4; ++side) {
        for (int step = 0; step <= kSteps; ++step) {
            const double along = static_cast<double>(step) / kSteps;
            const bool flat = side < 2; // top and bottom
            const double far = side % 2;
            const Point2 pixel{(flat ? along : far) * (width - 1), (flat ? far : along) * (height - 1)};
            const std::optional<Point2> seen = undistort(lens, pixel);
            const Point3 ray = seen ? turned(rectifying, {seen->x, seen->y, 1}) : Point3{0, 0, 0};
            if (!(ray.z > 0.05))
                return failure(Fault::kBadData,
                               "%s: the distortion cannot be undone at the pictures' border: calibrate again, with "
                               "boards that reach the borders",
                               name);
            const Point2 at{ray.x / ray.z, ray.y / ray.z};
            cover.outer_left = std::min(cover.outer_left, at.x);
            cover.outer_right = std::max(cover.outer_right, at.x);
            cover.outer_top = std::min(cover.outer_top, at.y);
            cover.outer_bottom = std::max(cover.outer_bottom, at.y);
            if (side == 0)
                cover.inner_top = std::max(cover.inner_top, at.y);
            else if (side == 1)
                cover.inner_bottom = std::min(cover.inner_bottom, at.y);
            else if (side == 2)
                cover.inner_left = std::max(cover.inner_left, at.x);
            else
                cover.inner_right = std::min(cover.inner_right, at.x);
            if (flat && (step == 0 || step == kSteps)) {
                cover.mean_x += at.x / 4;
                cover.mean_y += at.y / 4;
            }
        }
    }
    return cover;
}

bool border_has_source(const StereoRig& rig, const Rectification& flat)
{
    constexpr double kInside = 1.0 / 32; // twice what the table may be wrong
    const LensMap left(rig.left, flat.left_rectifying, flat.focal_px, flat.cx_px, flat.cy_px);
    const LensMap right(rig.right, flat.right_rectifying, flat.focal_px, flat.cx_px, flat.cy_px);
    const auto inside = [&](int x, int y) {
        for (const LensMap* map : {&left, &right}) {
            const Point2 at = map->source_of(x, y);
            if (!(at.x >= kInside && at.y >= kInside && at.x <= rig.width - 1 - kInside &&
                  at.y <= rig.height - 1 - kInside))
                return false;
        }
        return true;
    };
    for (int x = 0; x < flat.width; ++x)
        if (!inside(x, 0) || !inside(x, flat.height - 1))
            return false;
    for (int y = 0; y < flat.height; ++y)
        if (!inside(0, y) || !inside(flat.width - 1, y))
            return false;
    return true;
}

} // namespace

Result<Rectification> rectify(const StereoRig& rig, double keep, const char* name)
{
    TRY(check(rig, name));
    const Turn half = half_of(rig.turn);
    const Turn half_back = transposed(half);
    const Point3 shift = turned(half_back, rig.shift_mm);
    if (std::fabs(shift.y) > std::fabs(shift.x))
        return failure(Fault::kBadData,
                       "%s: the cameras stand above each other: turn the pictures by 90 degrees and calibrate them "
                       "as left and right",
                       name);
    if (!(shift.x < 0))
        return failure(Fault::kBadData,
                       "%s: left and right cameras are swapped (T(0) is %.6g mm and must be negative); swap the "
                       "pictures and calibrate again",
                       name, shift.x);
    const Turn level = onto_minus_x(shift);

    Rectification flat;
    flat.width = rig.width;
    flat.height = rig.height;
    flat.left_rectifying = product(level, half);
    flat.right_rectifying = product(level, half_back);
    flat.baseline_mm = std::sqrt(shift.x * shift.x + shift.y * shift.y + shift.z * shift.z);

    const Cover left = TRY(cover_of(rig.left, flat.left_rectifying, rig.width, rig.height, name));
    const Cover right = TRY(cover_of(rig.right, flat.right_rectifying, rig.width, rig.height, name));
    // The principal point that centres both pictures, at the focal length that OpenCV starts from.
    const double focal = (rig.left.fy + rig.right.fy) / 2;
    const double w = rig.width, h = rig.height;
    flat.cx_px = (w - 1) / 2 - focal * (left.mean_x + right.mean_x) / 2;
    flat.cy_px = (h - 1) / 2 - focal * (left.mean_y + right.mean_y) / 2;

    double crop = 0;
    double whole = 1e300;
    for (const Cover* cover : {&left, &right}) {
        if (!(cover->inner_left < 0 && cover->inner_right > 0 && cover->inner_top < 0 && cover->inner_bottom > 0) ||
            !(flat.cx_px > 0 && flat.cy_px > 0 && flat.cx_px < w - 1 && flat.cy_px < h - 1))
            return failure(Fault::kBadData,
                           "%s: the cameras do not look at the same scene when they are made parallel: calibrate "
                           "again",
                           name);
        crop = std::max({crop, flat.cx_px / -cover->inner_left, flat.cy_px / -cover->inner_top,
                         (w - 1 - flat.cx_px) / cover->inner_right, (h - 1 - flat.cy_px) / cover->inner_bottom});
        whole = std::min({whole, flat.cx_px / -cover->outer_left, flat.cy_px / -cover->outer_top,
                          (w - 1 - flat.cx_px) / cover->outer_right, (h - 1 - flat.cy_px) / cover->outer_bottom});
    }
    keep = std::clamp(keep, kCrop, kKeepAll);
    flat.focal_px = crop * (1 - keep) + whole * keep;
    // The border was sampled: a little more focal length until no pixel lacks its source.
    for (int step = 0; keep == kCrop && !border_has_source(rig, flat); ++step) {
        if (step == 400)
            return failure(Fault::kBadData,
                           "%s: no part of the pictures is without gaps when they are flat: calibrate again", name);
        flat.focal_px *= 1.0005;
    }
    return flat;
}

} // namespace dicot
