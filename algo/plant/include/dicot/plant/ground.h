// Where the plants stand: the plane of pot, soil or bench, and the frame upon it.
#pragma once

#include "dicot/base/cloud.h"

namespace dicot {

/// The second frame of a cloud, right-handed, z up. In mm of the first (rectified left camera: x right, y down, z
/// forward): p_ground = R (p_camera - origin), rows of R are `right`, `away`, `up`.
struct GroundFrame
{
    /// What z = 0 is.
    enum class Kind
    {
        kNone,
        kSoil,
        kBench
    };

    Kind kind = Kind::kNone; ///< kNone: no plane found; `up` is then the camera's, heights are not to be believed
    double origin_mm[3] = {0, 0, 0};
    double right[3] = {1, 0, 0};
    double away[3] = {0, 0, 1};
    double up[3] = {0, -1, 0};
    double rms_mm = 0;       ///< of the points that the plane was fitted to
    double height_sd_mm = 0; ///< one standard deviation of z = 0 where the plants stand
    double bench_mm =
        0; ///< z of the bench: 0 for kBench, below 0 for kSoil; what does not move as leaves hide the soil
};

} // namespace dicot
