// The depth experiment: every target of a folder matched, measured and held against its distance.
#pragma once

#include "../match_words.h"
#include "error_trend.h"
#include "face.h"
#include "target_list.h"

#include <string>
#include <vector>

namespace dicot::app {

struct DepthWords
{
    std::string rig;
    TargetWords targets;
    std::optional<double> near_mm, far_mm; ///< none: the rig file's, or what follows from the distances
    MatchWords match;
    bool whole = false; ///< match whole pictures
};

struct DepthReading
{
    Target target;
    FaceDepth face;
    double bound_mm = 0; ///< eq. 21 for kStepPx
    std::string lost;    ///< why there is no depth, for a person; empty when there is

    bool measured() const { return lost.empty(); }
    bool within_bound() const { return measured() && std::abs(face.error_mm) <= bound_mm; }
};

struct DepthRun
{
    std::vector<DepthReading> readings; ///< from near to far
    std::vector<LonePicture> alone;
    std::string source; ///< the table; empty: the names told the distances
    std::string rig_id; ///< empty: it has none
    RigGeometry rig;
    WorkingRange range;
    DisparityRange search;
    ErrorTrend trend;
    double seconds = 0;

    int measured() const;
    int within_bound() const;
    /// The reading with the largest error up to `most_mm`; nothing when none was measured there.
    const DepthReading* worst(double most_mm = 1e9) const;
};

/// Errors: those of list_targets() and of the rig file; Fault::kBadData: pictures of another size than the rig's, a
/// distance that this rig cannot measure, no depth from any target; those of disparity_range() and Matcher::check().
Result<DepthRun> run_depths(const DepthWords& words);

} // namespace dicot::app
