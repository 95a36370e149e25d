#include "dicot/rectification/rectify.h"

#include "dicot/rectification/lens_map.h"

#include <algorithm>
#include <cmath>

namespace dicot {
namespace {

using Vector3 = std::array<double, 3>;

constexpr double kShortestBaselineMm = 1.0;
constexpr double kOrthogonal = 1e-5; // what a text file's rounding may have done to a rotation

Vector3 turned(const Matrix3& m, const Vector3& v)
{
    return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
            m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

Matrix3 transposed(const Matrix3& m)
{
    return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
}

Matrix3 product(const Matrix3& a, const Matrix3& b)
{
    Matrix3 result{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            result[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
    return result;
}

Matrix3 rotation_of(double w, double x, double y, double z)
{
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    w /= length, x /= length, y /= length, z /= length;
    return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

/// Half of a turn by less than 90 degrees: of its quaternion (w, v), the one in the middle to the turn by nothing.
Matrix3 half_of(const Matrix3& turn)
{
    const double w = std::sqrt(1 + turn[0] + turn[4] + turn[8]) / 2;
    return rotation_of(1 + w, (turn[7] - turn[5]) / (4 * w), (turn[2] - turn[6]) / (4 * w),
                       (turn[3] - turn[1]) / (4 * w));
}

/// The shortest turn that brings `from` onto the negative x axis.
Matrix3 onto_minus_x(const Vector3& from)
{
    const double length = std::sqrt(from[0] * from[0] + from[1] * from[1] + from[2] * from[2]);
    const Vector3 unit{from[0] / length, from[1] / length, from[2] / length};
    return rotation_of(1 - unit[0], 0, -unit[2], unit[1]); // 1 + cosine, and unit x (-1, 0, 0)
}

bool finite(const StereoModel& model)
{
    bool all = true;
    for (const CameraModel* camera : {&model.left, &model.right}) {
        for (const double value : {camera->fx, camera->fy, camera->cx, camera->cy})
            all = all && std::isfinite(value);
        all = all && std::ranges::all_of(camera->distortion, [](double k) { return std::isfinite(k); });
    }
    all = all && std::ranges::all_of(model.right_from_left, [](double r) { return std::isfinite(r); });
    return all && std::ranges::all_of(model.translation_mm, [](double t) { return std::isfinite(t); });
}

bool is_rotation(const Matrix3& m)
{
    const Matrix3 square = product(m, transposed(m));
    for (std::size_t i = 0; i < 9; ++i)
        if (std::fabs(square[i] - (i % 4 == 0 ? 1.0 : 0.0)) > kOrthogonal)
            return false;
    const double determinant =
        m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
    return determinant > 0;
}

Status check(const StereoModel& model, const char* name)
{
    if (!finite(model))
        return failure(Fault::kBadData, "%s: a number of the calibration is not finite: calibrate again", name);
    if (model.width < 8 || model.height < 8 || model.width > 16384 || model.height > 16384)
        return failure(Fault::kBadData,
                       "%s: pictures of %d x %d px cannot be rectified (8 to 16384 on a side): calibrate with the "
                       "cameras' real size",
                       name, model.width, model.height);
    for (const CameraModel* camera : {&model.left, &model.right})
        if (!(camera->fx > 1) || !(camera->fy > 1))
            return failure(Fault::kBadData, "%s: a focal length of %.6g x %.6g px is senseless: calibrate again", name,
                           camera->fx, camera->fy);
    if (!is_rotation(model.right_from_left))
        return failure(Fault::kBadData, "%s: R is no rotation: calibrate again", name);
    if (!(model.right_from_left[0] + model.right_from_left[4] + model.right_from_left[8] > 1))
        return failure(Fault::kBadData,
                       "%s: the cameras look in directions more than 90 degrees apart: calibrate again", name);
    const auto& t = model.translation_mm;
    if (!(std::fabs(t[0]) >= kShortestBaselineMm) && !(std::fabs(t[1]) >= kShortestBaselineMm))
        return failure(Fault::kBadData,
                       "%s: the baseline is %.6g mm, too short for two cameras: if the file's lengths are metres, "
                       "add the line 'unit: m'",
                       name, std::fabs(t[0]));
    return {};
}

/// What the pictures of one camera cover of the rectified plane at focal length 1, from points along the border.
struct Cover
{
    double mean_x = 0, mean_y = 0;                           ///< of the four corners
    double inner_left, inner_right, inner_top, inner_bottom; ///< inside of the border
    double outer_left, outer_right, outer_top, outer_bottom; ///< around it
};

Result<Cover> cover_of(const CameraModel& camera, const Matrix3& rectifying, int width, int height, const char* name)
{
    constexpr int kSteps = 64;
    Cover cover{0, 0, -1e9, 1e9, -1e9, 1e9, 1e9, -1e9, 1e9, -1e9};
    for (int side = 0; side < 4; ++side) {
        for (int step = 0; step <= kSteps; ++step) {
            const double along = static_cast<double>(step) / kSteps;
            const bool flat = side < 2; // top and bottom
            const double far = side % 2;
            const Position pixel{(flat ? along : far) * (width - 1), (flat ? far : along) * (height - 1)};
            const std::optional<Position> seen = direction_of(camera, pixel);
            const Vector3 ray = seen ? turned(rectifying, {seen->x, seen->y, 1}) : Vector3{0, 0, 0};
            if (!(ray[2] > 0.05))
                return failure(Fault::kBadData,
                               "%s: the distortion cannot be undone at the pictures' border: calibrate again, with "
                               "boards that reach the borders",
                               name);
            const Position at{ray[0] / ray[2], ray[1] / ray[2]};
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

bool border_has_source(const StereoModel& model, const Rectification& flat)
{
    constexpr double kInside = 1.0 / 32; // twice what the table may be wrong
    const LensMap left(model.left, flat.left_rectifying, flat.focal_px, flat.cx_px, flat.cy_px);
    const LensMap right(model.right, flat.right_rectifying, flat.focal_px, flat.cx_px, flat.cy_px);
    const auto inside = [&](int x, int y) {
        for (const LensMap* map : {&left, &right}) {
            const Position at = map->source_of(x, y);
            if (!(at.x >= kInside && at.y >= kInside && at.x <= model.width - 1 - kInside &&
                  at.y <= model.height - 1 - kInside))
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

Result<Rectification> rectify(const StereoModel& model, double keep, const char* name)
{
    TRY(check(model, name));
    const Matrix3 half = half_of(model.right_from_left);
    const Matrix3 half_back = transposed(half);
    const Vector3 shift = turned(half_back, model.translation_mm);
    if (std::fabs(shift[1]) > std::fabs(shift[0]))
        return failure(Fault::kBadData,
                       "%s: the cameras stand above each other: turn the pictures by 90 degrees and calibrate them "
                       "as left and right",
                       name);
    if (!(shift[0] < 0))
        return failure(Fault::kBadData,
                       "%s: left and right cameras are swapped (T(0) is %.6g mm and must be negative); swap the "
                       "pictures and calibrate again",
                       name, shift[0]);
    const Matrix3 level = onto_minus_x(shift);

    Rectification flat;
    flat.width = model.width;
    flat.height = model.height;
    flat.left_rectifying = product(level, half);
    flat.right_rectifying = product(level, half_back);
    flat.baseline_mm = std::sqrt(shift[0] * shift[0] + shift[1] * shift[1] + shift[2] * shift[2]);

    const Cover left = TRY(cover_of(model.left, flat.left_rectifying, model.width, model.height, name));
    const Cover right = TRY(cover_of(model.right, flat.right_rectifying, model.width, model.height, name));
    // The principal point that centres both pictures, at the focal length that OpenCV starts from.
    double focal = 1e300;
    const double w = model.width, h = model.height;
    for (const CameraModel* camera : {&model.left, &model.right}) {
        const double k1 = camera->distortion[0];
        const double own =
            k1 < 0 ? camera->fy * (1 + k1 * (w * w + h * h) / (4 * camera->fy * camera->fy)) : camera->fy;
        focal = std::min(focal, own);
    }
    if (!(focal > 1))
        return failure(Fault::kBadData, "%s: the distortion is too strong for a flat picture: calibrate again", name);
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
    for (int step = 0; keep == kCrop && !border_has_source(model, flat); ++step) {
        if (step == 400)
            return failure(Fault::kBadData,
                           "%s: no part of the pictures is without gaps when they are flat: calibrate again", name);
        flat.focal_px *= 1.0005;
    }
    return flat;
}

} // namespace dicot
