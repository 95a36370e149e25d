// Any bytes at all through the rig file's reader.
#include "dicot/rig/rig_file.h"

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

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot;
    const Result<RigFile> rig = parse_rig(std::as_bytes(std::span{data, size}), "fuzz");
    if (!rig.ok()) {
        require_named(rig.status());
        return 0;
    }
    require(rig.value().width >= 1 && rig.value().width <= kMaxRigPictureSide);
    require(rig.value().height >= 1 && rig.value().height <= kMaxRigPictureSide);
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
