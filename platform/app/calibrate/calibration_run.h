// What one calibration saw, solved and thinks of itself: what the command, its report and the rig file are made of.
#pragma once

#include "pair_files.h"

#include "dicot/base/work.h"
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

    std::string left_name; ///< the two halves of the name
    std::string right_name;
    int set = 0; ///< index into the plan's sets
};

/// A folder and the boards that its pictures may show.
struct PictureSet
{
    std::string folder;
    std::vector<calibration::Board> boards;
};

struct CalibrationPlan
{
    std::vector<PictureSet> sets;
    calibration::WorkingRange range;
    bool fit_k3 = false;
    bool fit_warp = false;
};

struct CalibrationRun
{
    std::vector<SeenPair> pairs;
    std::vector<LonePicture> alone; ///< without a partner
    calibration::CalibrationTask task;
    calibration::StereoCalibration calibration;
    calibration::WorkingRange range;
    calibration::Quality quality;
    RigFile rig; ///< as written

    bool solved = false;  ///< calibration, range, quality and rig are there
    double finding_s = 0; ///< time that the pictures took, and all the rest
    double solving_s = 0;
};

/// Finds the pairs: names, paths and the size of the pictures; none is decoded.
/// Fault::kNoInput: no folder, no pictures, no pair. Fault::kBadData: pictures of different sizes.
Status list_pairs(const CalibrationPlan& plan, CalibrationRun& run);

/// Looks for the boards and solves. The result is the same for every crew. After a failure the run holds what was seen
/// until then: the pairs and why they are not used, no calibration, and the reason as quality.advice. Fault::kBadData,
/// with the reason and advice: no board anywhere, and all that solve_stereo() refuses.
Status calibrate(const CalibrationPlan& plan, CalibrationRun& run, Crew& crew);

} // namespace dicot::app
