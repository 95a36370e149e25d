#include "own_rig.h"

#include "calibration_data.h"

namespace dicot::test {
namespace {

StereoRig solved()
{
    CalibrationTask task;
    add_pairs(kBoard10, task);
    add_pairs(kBoard8, task);
    const auto calibration = calibration::solve_stereo(task);
    if (!calibration.ok()) {
        std::fprintf(stderr, "%s\n", calibration.status().message());
        std::exit(calibration.status().exit_code());
    }
    const calibration::StereoCalibration& c = calibration.value();
    std::printf("own calibration: %d pairs of pictures, RMS %.3f px, baseline %.3f mm\n", c.pairs_used, c.rms_px,
                c.rig.baseline_mm());
    return c.rig;
}

} // namespace

const StereoRig& own_rig()
{
    static const StereoRig rig = solved();
    return rig;
}

} // namespace dicot::test
