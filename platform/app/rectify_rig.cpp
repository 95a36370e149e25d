#include "rectify_rig.h"

#include "stored_maps.h"

#include "dicot/os/clock.h"
#include "dicot/os/shown_path.h"

#include <algorithm>
#include <cstdio>
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

void print_table(const char* side, const RemapTable& table)
{
    const double pixels = static_cast<double>(table.width()) * table.height();
    std::printf("%-5s table: cells of %d px, %.1f KiB, worst error %.5f px of %.5f allowed, %.2f %% of the pixels have "
                "a source\n",
                side, table.cell_px(), static_cast<double>(table.table_bytes()) / 1024, table.worst_error_px(),
                RemapTable::kMostErrorPx, 100 * static_cast<double>(table.pixels_with_source()) / pixels);
}

namespace {

struct Carved
{
    std::span<std::byte> maps;
    std::span<RemapSpan> spans;
};

Carved carve(Arena& arena, int width, int height)
{
    const std::size_t each = RemapTable::most_bytes(width, height);
    Carved carved;
    carved.maps = arena.take<std::byte>(2 * each);
    carved.spans = arena.take<RemapSpan>(static_cast<std::size_t>(width));
    return carved;
}

Result<RigMaps> build_maps(const StereoRig& rig, const Rectification& flat, Arena arena, const char* name)
{
    const auto table_of = [&](const Lens& lens, const Turn& rectifying) {
        return RemapTable::build(LensMap(lens, rectifying, flat.focal_px, flat.cx_px, flat.cy_px), rig.width,
                                 rig.height, arena, name);
    };
    RigMaps maps;
    maps.left = TRY(table_of(rig.left, flat.left_rectifying));
    maps.right = TRY(table_of(rig.right, flat.right_rectifying));
    return maps;
}

} // namespace

std::size_t RectifyTables::reserved_bytes(int width, int height)
{
    Arena measure;
    (void)carve(measure, width, height);
    return measure.peak();
}

std::string RectifyTables::origin() const
{
    char text[64];
    std::snprintf(text, sizeof text, " in %.1f ms", milliseconds_);
    return (loaded_from_.empty() ? std::string("built") : "loaded from " + loaded_from_) + text;
}

Result<RectifyTables> RectifyTables::make(RigFile& rig, double keep, const char* rig_path, bool may_load)
{
    const char* name = shown_path(rig_path);
    const std::int64_t start_us = monotonic_us();
    const StereoRig stereo = TRY(stereo_rig_of(rig, rig_path));
    const Rectification flat = TRY(rectify(stereo, keep, name));
    RectifyTables tables{TRY(MemoryBlock::map(reserved_bytes(rig.width, rig.height)))};
    Arena arena(tables.block_.bytes());
    const Carved carved = carve(arena, rig.width, rig.height);
    tables.spans_ = carved.spans;
    std::optional<RigMaps> loaded;
    const std::string path = maps_path(rig_path);
    if (may_load)
        loaded = load_maps(path, stereo, keep, Arena{carved.maps}, name);
    if (loaded)
        tables.loaded_from_ = path;
    tables.maps_ = loaded ? *loaded : TRY(build_maps(stereo, flat, Arena{carved.maps}, name));
    set_rectification(rig, flat);
    tables.milliseconds_ = static_cast<double>(monotonic_us() - start_us) * 1e-3;
    return tables;
}

Result<RectifyTables> RectifyTables::build(RigFile& rig, double keep, const char* name)
{
    return make(rig, keep, name, false);
}

Result<RectifyTables> RectifyTables::load_or_build(RigFile& rig, double keep, const char* rig_path)
{
    return make(rig, keep, rig_path, true);
}

} // namespace dicot::app
