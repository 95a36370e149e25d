// Takes the pairs of a live calibration: from the cameras to a folder, as the guide says.
#pragma once

#include "dicot/base/work.h"
#include "dicot/calibration/quality.h"

#include <string>

namespace dicot::app {

struct LivePlan
{
    calibration::Board board;
    calibration::WorkingRange range;
    int pairs = 20;     ///< wanted, LiveGuide::kMostPairs at most
    double seconds = 0; ///< after which the run ends with the pairs that there are
    std::string folder; ///< that they go to
    bool resume = false;
    std::string config; ///< path of the configuration; empty: the usual one
    std::string rig;    ///< path of the rig file, for sentences
    bool json = false;
};

/// Returns when all pairs are taken, or the time is over and calibration::kMinPairs at least are there. Pairs that
/// were taken stay in the folder whatever happens, and a sentence on stderr says how to go on with them.
/// Errors: Fault::kTryAgain: stopped by a signal, or too few pairs in the time; those of load_config(),
/// RigStream::open() and next(), and PairFolder.
Status take_pairs(const LivePlan& plan, Crew& crew);

} // namespace dicot::app
