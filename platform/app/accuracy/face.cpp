#include "face.h"

#include "dicot/os/shown_path.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dicot::app {
namespace {

constexpr int kAroundPx = 48; // more than the window's radius, and what neighbours say to each other

double median(std::vector<double>& values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    if (values.size() % 2 == 1)
        return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double dot(const Point3& a, const Point3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

} // namespace

std::optional<Point2> LeftView::rectified(Point2 pixel) const
{
    if (!lens)
        return pixel;
    const std::optional<Point2> seen = undistort(*lens, pixel);
    if (!seen)
        return std::nullopt;
    const Point3 p = turned(from_camera, {seen->x, seen->y, 1});
    if (!(p.z > 0))
        return std::nullopt;
    return Point2{rig.focal_px * p.x / p.z + rig.cx_px, rig.focal_px * p.y / p.z + rig.cy_px};
}

Point3 LeftView::direction(double x, double y) const
{
    return turned(transposed(from_camera), {(x - rig.cx_px) / rig.focal_px, (y - rig.cy_px) / rig.focal_px, 1});
}

Result<Face> Face::of(const Target& target, const LeftView& view)
{
    Face face;
    const char* shown = shown_path(target.left_path.c_str());
    double least_x = 1e9, most_x = -1e9, least_y = 1e9, most_y = -1e9;
    for (std::size_t k = 0; k < target.corners.size(); ++k) {
        const std::optional<Point2> corner = view.rectified(target.corners[k]);
        if (!corner)
            return failure(Fault::kBadData, "%s: corner %zu of the target cannot be rectified: it lies too far outside",
                           shown, k + 1);
        face.corners_[k] = *corner;
        least_x = std::min(least_x, corner->x), most_x = std::max(most_x, corner->x);
        least_y = std::min(least_y, corner->y), most_y = std::max(most_y, corner->y);
    }
    const auto pixel = [](double value, int most) { return static_cast<int>(std::clamp(value, 0.0, double(most))); };
    face.bounds_ = {pixel(std::ceil(least_x), view.rig.width), pixel(std::floor(most_x) + 1, view.rig.width),
                    pixel(std::ceil(least_y), view.rig.height), pixel(std::floor(most_y) + 1, view.rig.height)};
    int inside = 0;
    for (int y = face.bounds_.top; y < face.bounds_.bottom; ++y)
        for (int x = face.bounds_.first; x < face.bounds_.end; ++x)
            inside += face.contains(x, y) ? 1 : 0;
    if (inside < kLeastPixels)
        return failure(Fault::kBadData,
                       "%s: %d px of the target lie in the rectified picture, and %d are needed: its place in the "
                       "picture is wrong, or the target is too small or outside of what both cameras see",
                       shown, inside, kLeastPixels);
    return face;
}

bool Face::contains(int x, int y) const
{
    // On one side of all four edges, whichever way round they go.
    int left = 0, right = 0;
    for (std::size_t k = 0; k < corners_.size(); ++k) {
        const Point2& a = corners_[k];
        const Point2& b = corners_[(k + 1) % corners_.size()];
        const double side = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        left += side < 0 ? 1 : 0;
        right += side > 0 ? 1 : 0;
    }
    return left == 0 || right == 0;
}

PictureRange matched_part(const Face& face, const RigGeometry& rig, const DisparityRange& search)
{
    const PictureRange& in = face.bounds();
    PictureRange part;
    // On the left also all that the right picture may show of the face.
    part.first = std::max({0, search.min_disparity, in.first - kAroundPx - search.disparities});
    part.end = std::min({rig.width, rig.width + search.min_disparity, in.end + kAroundPx});
    part.top = std::max(0, in.top - kAroundPx);
    part.bottom = std::min(rig.height, in.bottom + kAroundPx);
    // The matcher wants a picture as wide as the range at least.
    part.end =
        std::max(part.end, std::min(part.first + search.disparities, rig.width + std::min(0, search.min_disparity)));
    return part;
}

FaceDepth measure(const Target& target, const Face& face, const LeftView& view, const PictureRange& part,
                  const DisparityRange& search, const DisparityMap& map)
{
    FaceDepth found;
    std::vector<double> errors, disparities;
    const RigGeometry& rig = view.rig;
    const PictureRange& in = face.bounds();
    for (int y = in.top; y < in.bottom; ++y)
        for (int x = in.first; x < in.end; ++x) {
            if (!face.contains(x, y))
                continue;
            ++found.pixels;
            if (x < part.first || x >= part.end)
                continue; // the right camera does not see it
            const DispQ8 relative = map.relative.at(x - part.first, y - part.top);
            if (relative == kDispMissing)
                continue;
            const double disparity =
                search.min_disparity + map.min_disparity + relative / 256.0 + rig.disparity_offset_px;
            if (!(disparity > 0))
                continue;
            const Point3 direction = view.direction(x, y);
            const double depth_mm = rig.focal_px * rig.baseline_mm / disparity * direction.z;
            const double true_mm = target.plane ? dot(target.plane->normal, target.plane->point) /
                                                      dot(target.plane->normal, direction) * direction.z
                                                : target.distance_mm;
            errors.push_back(depth_mm - true_mm);
            disparities.push_back(rig.focal_px * rig.baseline_mm / true_mm * direction.z - rig.disparity_offset_px);
        }
    found.valued = static_cast<int>(errors.size());
    if (errors.empty())
        return found;
    found.error_mm = median(errors);
    found.disparity_px = median(disparities);
    found.measured_mm = target.distance_mm + found.error_mm;
    std::vector<double> sizes, away;
    for (const double error : errors) {
        sizes.push_back(std::abs(error));
        away.push_back(std::abs(error - found.error_mm));
    }
    found.spread_mm = median(away);
    const std::size_t rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(sizes.size()))) - 1;
    std::ranges::nth_element(sizes, sizes.begin() + static_cast<std::ptrdiff_t>(rank));
    found.point_mm = sizes[rank];
    return found;
}

double depth_bound_mm(const RigGeometry& rig, double distance_mm, double off_px)
{
    return distance_mm * distance_mm / (rig.focal_px * rig.baseline_mm) * off_px;
}

} // namespace dicot::app
