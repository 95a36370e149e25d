#include "rectified_view.h"

#include "dicot/kernels/kernels.h"

#include <cmath>
#include <limits>

namespace dicot::test {

Disparities disparities_of(const DisparityMap& map)
{
    Disparities made{map.relative.width, map.relative.height, {}, {}};
    for (int y = 0; y < made.height; ++y)
        for (int x = 0; x < made.width; ++x) {
            const DispQ8 value = map.relative.at(x, y);
            made.px.push_back(value == kDispMissing ? std::numeric_limits<float>::quiet_NaN()
                                                    : static_cast<float>(map.min_disparity) +
                                                          static_cast<float>(value) / (1 << kDispFractionBits));
            made.confidence.push_back(map.confidence.at(x, y));
        }
    return made;
}

RectifiedView::RectifiedView(const StereoRig& rig)
    : rig_(rig), flat_(rectify(rig, kCrop, "the rig").value()),
      memory_(2 * RemapTable::most_bytes(rig.width, rig.height))
{
    const auto table = [&](const Lens& lens, const Turn& turn) {
        const LensMap map(lens, turn, flat_.focal_px, flat_.cx_px, flat_.cy_px);
        return RemapTable::build(map, rig.width, rig.height, memory_.arena(), "the rig").value();
    };
    maps_.left = table(rig.left, flat_.left_rectifying);
    maps_.right = table(rig.right, flat_.right_rectifying);
    for (int y = 0; y < rig.height; ++y)
        for (int x = 0; x < rig.width; ++x) {
            const auto ray = undistort(rig.left, {static_cast<double>(x), static_cast<double>(y)});
            const Point2 at = ray ? seen({ray->x, ray->y, 1}).pixel : Point2{-1, -1};
            const long column = std::lround(at.x), row = std::lround(at.y);
            const bool inside = column >= 0 && row >= 0 && column < rig.width && row < rig.height;
            nearest_.push_back(inside ? static_cast<std::int32_t>(row * rig.width + column) : -1);
        }
}

RigGeometry RectifiedView::geometry() const
{
    return {flat_.width, flat_.height, flat_.focal_px, flat_.cx_px, flat_.cy_px, 0, flat_.baseline_mm};
}

DisparityRange RectifiedView::range() const
{
    return disparity_range(geometry(), kWorkingRange).value();
}

MatchOptions RectifiedView::options(MatchMethod method) const
{
    MatchOptions options;
    options.method = method;
    options.min_disparity = range().min_disparity;
    options.disparities = range().disparities;
    return options;
}

RectifiedView::Seen RectifiedView::seen(const Point3& in_left) const
{
    const Point3 p = turned(flat_.left_rectifying, in_left);
    return {{flat_.cx_px + flat_.focal_px * p.x / p.z, flat_.cy_px + flat_.focal_px * p.y / p.z},
            flat_.focal_px * flat_.baseline_mm / p.z};
}

RawDepth RectifiedView::on_raw_pixels(const Disparities& disparities) const
{
    const Turn back = transposed(flat_.left_rectifying);
    RawDepth depth;
    depth.mm.reserve(nearest_.size());
    depth.confidence.reserve(nearest_.size());
    for (const std::int32_t i : nearest_) {
        const float px = i < 0 ? std::numeric_limits<float>::quiet_NaN() : disparities.px[static_cast<std::size_t>(i)];
        const double z = flat_.focal_px * flat_.baseline_mm / static_cast<double>(px);
        if (!(z >= kWorkingRange.near_mm && z <= kWorkingRange.far_mm)) {
            depth.mm.push_back(std::numeric_limits<float>::quiet_NaN());
            depth.confidence.push_back(0);
            continue;
        }
        const double x = (i % flat_.width - flat_.cx_px) / flat_.focal_px;
        const double y = (i / flat_.width - flat_.cy_px) / flat_.focal_px;
        depth.mm.push_back(static_cast<float>(turned(back, {x * z, y * z, z}).z));
        depth.confidence.push_back(
            disparities.confidence.empty() ? std::uint8_t{0} : disparities.confidence[static_cast<std::size_t>(i)]);
    }
    return depth;
}

scenes::Picture RectifiedView::remapped(const RemapTable& table, const scenes::Picture& raw)
{
    scenes::Picture flat{raw.width, raw.height, std::vector<Rgb8>(raw.pixels.size())};
    std::vector<RemapSpan> spans(static_cast<std::size_t>(table.columns()));
    remap(table, kScalarKernels, raw.view(), flat.view(), spans);
    return flat;
}

} // namespace dicot::test
