#include "rectify_rig.h"

#include "dicot/os/shown_path.h"

#include <algorithm>
#include <utility>

namespace dicot::app {
namespace {

Matrix<3, 3> rows_of(const Turn& m)
{
    return {{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}}};
}

Result<Lens> lens_of(const RigCamera& camera, const char* path)
{
    const Matrix<3, 3>& k = *camera.intrinsic;
    if (k[0][1] != 0 || k[1][0] != 0 || k[2] != std::array<double, 3>{0, 0, 1})
        return failure(Fault::kBadData,
                       "%s: K1 and K2 must have the form fx 0 cx, 0 fy cy, 0 0 1: calibrate without skew", path);
    Lens lens{k[0][0], k[1][1], k[0][2], k[1][2], {}};
    if (camera.distortion) {
        std::copy_n(camera.distortion->at.begin(), lens.k.size(), lens.k.begin());
        if (camera.distortion->at[12] != 0 || camera.distortion->at[13] != 0)
            return failure(Fault::kBadData,
                           "%s: tilted sensors (the 13th and 14th number of D1 and D2) are not known here: calibrate "
                           "without the tilted model",
                           path);
    }
    return lens;
}

} // namespace

bool describes_cameras(const RigFile& rig)
{
    return rig.left.intrinsic && rig.right.intrinsic && rig.rotation && rig.translation_mm;
}

Result<StereoRig> stereo_rig_of(const RigFile& rig, const char* name)
{
    const char* path = shown_path(name);
    if (!describes_cameras(rig))
        return failure(Fault::kBadData,
                       "%s: K1, K2, R and T are needed to rectify, and one of them is missing: give the file that "
                       "'dicot calibrate' wrote",
                       path);
    StereoRig stereo;
    stereo.width = rig.width;
    stereo.height = rig.height;
    stereo.left = TRY(lens_of(rig.left, path));
    stereo.right = TRY(lens_of(rig.right, path));
    for (std::size_t i = 0; i < 9; ++i)
        stereo.turn[i] = (*rig.rotation)[i / 3][i % 3];
    const auto& [x, y, z] = *rig.translation_mm;
    stereo.shift_mm = {x, y, z};
    return stereo;
}

void set_rectification(RigFile& rig, const Rectification& flat)
{
    const double f = flat.focal_px;
    rig.left.rectifying = rows_of(flat.left_rectifying);
    rig.right.rectifying = rows_of(flat.right_rectifying);
    rig.left.projection = {{{f, 0, flat.cx_px, 0}, {0, f, flat.cy_px, 0}, {0, 0, 1, 0}}};
    rig.right.projection = {{{f, 0, flat.cx_px, -f * flat.baseline_mm}, {0, f, flat.cy_px, 0}, {0, 0, 1, 0}}};
    rig.reprojection = {
        {{1, 0, 0, -flat.cx_px}, {0, 1, 0, -flat.cy_px}, {0, 0, 0, f}, {0, 0, 1 / flat.baseline_mm, 0}}};
}

Result<RectifyTables> RectifyTables::make(RigFile& rig, double keep, const char* name)
{
    const char* path = shown_path(name);
    const StereoRig stereo = TRY(stereo_rig_of(rig, name));
    const Rectification flat = TRY(rectify(stereo, keep, path));
    Arena measure;
    const std::size_t each = RemapTable::most_bytes(rig.width, rig.height);
    (void)measure.take<std::byte>(each);
    (void)measure.take<std::byte>(each);
    const auto most_spans = static_cast<std::size_t>(rig.width);
    (void)measure.take<RemapSpan>(most_spans);
    RectifyTables tables{TRY(MemoryBlock::map(measure.peak()))};
    Arena arena(tables.block_.bytes());
    tables.left_ =
        TRY(RemapTable::build(LensMap(stereo.left, flat.left_rectifying, flat.focal_px, flat.cx_px, flat.cy_px),
                              rig.width, rig.height, arena, path));
    tables.right_ =
        TRY(RemapTable::build(LensMap(stereo.right, flat.right_rectifying, flat.focal_px, flat.cx_px, flat.cy_px),
                              rig.width, rig.height, arena, path));
    tables.spans_ = arena.take<RemapSpan>(most_spans);
    if (arena.overrun())
        return failure(Fault::kSoftware, "%s: the memory for the rectification tables was measured too small", path);
    set_rectification(rig, flat);
    return tables;
}

} // namespace dicot::app
