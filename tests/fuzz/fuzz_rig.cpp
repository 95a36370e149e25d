// Any bytes at all through the readers of rig files and of camera_info pairs.
#include "dicot/rig/rig_file.h"
#include "dicot/rig/rig_id.h"
#include "dicot/rig/ros_files.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

namespace {

void require(bool promise)
{
    if (!promise)
        std::abort();
}

void require_named(const dicot::Status& status)
{
    require(status.fault() == dicot::Fault::kBadData);
    require(std::strncmp(status.message(), "fuzz: ", 6) == 0);
}

void require_finite(const dicot::RigFile& rig)
{
    const auto all = [](const auto& matrix) {
        if (matrix)
            for (const auto& row : *matrix)
                for (const double value : row)
                    require(std::isfinite(value));
    };
    for (const dicot::RigCamera* camera : {&rig.left, &rig.right}) {
        all(camera->intrinsic);
        all(camera->rectifying);
        all(camera->projection);
        if (camera->distortion)
            for (const double value : camera->distortion->at)
                require(std::isfinite(value));
    }
    all(rig.rotation);
    all(rig.reprojection);
    if (rig.translation_mm)
        for (const double value : *rig.translation_mm)
            require(std::isfinite(value));
    if (rig.quality)
        for (const double value : {rig.quality->rms_px, rig.quality->held_out_mm, rig.quality->depth_error_mm[2],
                                   rig.quality->farthest_mm - rig.quality->nearest_mm})
            require(value >= 0);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot;
    const auto text = std::as_bytes(std::span{data, size});
    const Result<RigFile> cameras = parse_ros(text, text, "fuzz");
    require(cameras.ok() ? std::isfinite((*cameras.value().reprojection)[3][2])
                         : cameras.status().fault() == Fault::kBadData);
    const Result<RigFile> rig = parse_rig(text, "fuzz");
    if (!rig.ok()) {
        require_named(rig.status());
        return 0;
    }
    require(rig.value().width >= 1 && rig.value().width <= kMaxRigPictureSide);
    require(rig.value().height >= 1 && rig.value().height <= kMaxRigPictureSide);
    require_finite(rig.value());
    RigFile named = rig.value();
    set_id(named);
    require(id_matches(named));
    const Result<RigGeometry> geometry = geometry_of(rig.value(), "fuzz");
    if (!geometry.ok()) {
        require_named(geometry.status());
        return 0;
    }
    const RigGeometry& found = geometry.value();
    require(found.baseline_mm > 0 && found.focal_px > 0);
    for (const double value : {found.focal_px, found.cx_px, found.cy_px, found.disparity_offset_px, found.baseline_mm})
        require(std::isfinite(value));
    return 0;
}
