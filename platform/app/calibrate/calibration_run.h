// What one calibration saw, solved and thinks of itself: what the command, its report and the rig file are made of.
#pragma once

#include "dicot/calibration/quality.h"
#include "dicot/rig/rig_file.h"

#include <string>
#include <vector>

namespace dicot::app {

/// One pair of pictures and what became of it.
struct SeenPair
{
    std::string name; ///< for sentences: "left07.jpg and right07.jpg"
    std::string left_path;
    std::string right_path;
    int board = -1; ///< index into the task's boards; -1: none was found
    int view = -1;  ///< index into the task's views; -1: not given to the solver
    calibration::BoardSight left;
    calibration::BoardSight right;
    std::string rejected; ///< why it is not used, with the side, for a person; empty when used
};

struct CalibrationRun
{
    std::vector<SeenPair> pairs;
    calibration::CalibrationTask task;
    calibration::StereoCalibration calibration;
    calibration::WorkingRange range;
    calibration::Quality quality;
    RigFile rig; ///< as written
};

} // namespace dicot::app
