// The rendered rig's true cameras, and rectification tables in memory of a test's own.
#pragma once

#include "dicot/rectification/rectify.h"
#include "dicot/rectification/rig_maps.h"

#include <memory>
#include <span>
#include <vector>

namespace dicot::test {

/// As in the shared data, rig-dev/plants/gt_calib.yml: two webcams of 1280 x 720 px.
inline StereoRig rendered_rig()
{
    StereoRig rig;
    rig.width = 1280;
    rig.height = 720;
    rig.left = {777.89276786340088,
                779.22841480213208,
                638.20879698541989,
                359.94927648284801,
                {-0.10451280577602631, 0.039583562349614201, 6.4668286917118727e-04, -9.7136284707223563e-04}};
    rig.right = {783.05460860099208,
                 781.84721187021341,
                 649.95462525230630,
                 358.40482391422904,
                 {-0.14228166762931541, 0.028297523822456185, 1.3748218827529797e-03, -1.1776613385286675e-03}};
    rig.turn = {9.9979302529515746e-01,  1.8468642903365546e-02,  8.5332174743929512e-03,
                -1.8639456633073443e-02, 9.9961830559038156e-01,  2.0391512573594013e-02,
                -8.1533568290057135e-03, -2.0546346583352321e-02, 9.9975565535509547e-01};
    rig.shift_mm = {-84.985154252604417, 1.0246794468807228, 1.2139146148627700};
    return rig;
}

inline LensMap map_of(const Lens& lens, const Turn& turn, const Rectification& flat)
{
    return {lens, turn, flat.focal_px, flat.cx_px, flat.cy_px};
}

/// An arena of a test's own.
class Memory
{
public:
    explicit Memory(std::size_t bytes) : block_(bytes + Arena::kAlignment) {}
    Arena arena()
    {
        void* start = block_.data();
        std::size_t space = block_.size();
        std::align(Arena::kAlignment, 1, start, space);
        return Arena{{static_cast<std::byte*>(start), space}};
    }

private:
    std::vector<std::byte> block_;
};

/// Both tables of the rendered rig.
struct RenderedMaps
{
    StereoRig rig = rendered_rig();
    Rectification flat;
    Memory memory{2 * RemapTable::most_bytes(1280, 720)};
    RigMaps maps;
    mutable std::vector<RemapSpan> spans = std::vector<RemapSpan>(1280);

    explicit RenderedMaps(double keep = kCrop) : flat(rectify(rig, keep, "rig.yaml").value())
    {
        Arena arena = memory.arena();
        maps.left =
            RemapTable::build(map_of(rig.left, flat.left_rectifying, flat), 1280, 720, arena, "rig.yaml").value();
        maps.right =
            RemapTable::build(map_of(rig.right, flat.right_rectifying, flat), 1280, 720, arena, "rig.yaml").value();
    }
};

} // namespace dicot::test
