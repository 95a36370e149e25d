// What the report works out again from a calibration, corner by corner.
#pragma once

#include "calibration_run.h"

#include "dicot/rectification/rectify.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dicot::app {

enum class Eye
{
    kLeft,
    kRight
};
constexpr std::array<Eye, 2> kEyes{Eye::kLeft, Eye::kRight};
const char* name_of(Eye eye);

/// A corner of a used view and by how much it misses its predicted place, px.
struct CornerMiss
{
    Point2 seen;
    Point2 miss; ///< seen minus predicted
};

/// All corners that the solution rests on, in the order of the task.
std::vector<CornerMiss> corner_misses(const CalibrationRun& run, Eye eye);

/// Whether there is a calibration; a refused one leaves the pairs alone.
bool is_solved(const CalibrationRun& run);

/// Whether the pair was given to the solver and kept with both of its pictures.
bool is_used(const CalibrationRun& run, const SeenPair& pair);
/// What the solver says of the pair; null when it was not given to it, or refused all.
const calibration::ViewOutcome* outcome_of(const CalibrationRun& run, const SeenPair& pair);
/// Why the pair is not used, or used for one lens alone; empty when it is used.
std::string reason_of(const CalibrationRun& run, const SeenPair& pair);

/// Index of the used pair whose corners lie nearest to the middle of both pictures; nothing when none is used.
std::optional<std::size_t> middle_pair(const CalibrationRun& run);

/// A pixel of a camera's picture in its rectified picture.
std::optional<Point2> rectified(const StereoRig& rig, const Rectification& flat, Eye eye, Point2 pixel);

/// Left row minus right row of the same corner in the rectified pictures, px.
struct RowGaps
{
    std::vector<double> gaps_px;
    double rms_px = 0;
    double p95_px = 0; ///< of the sizes
    double most_px = 0;

    void add(const StereoRig& rig, const Rectification& flat, std::span<const Point2> left,
             std::span<const Point2> right);
    /// Fills the summaries.
    void sum_up();
};

/// Of all used pairs.
RowGaps row_gaps(const CalibrationRun& run, const Rectification& flat);

/// The thirds of a picture's sides make nine parts, in reading order.
constexpr std::array<const char*, 9> kPartNames{"upper left",   "upper middle", "upper right",  "middle left", "middle",
                                                "middle right", "lower left",   "lower middle", "lower right"};
/// Whether more than half of a part's cells are without corners.
bool part_is_empty(const calibration::Coverage& coverage, std::size_t part);

/// Thirds of the picture without corners in more than half of their cells ("upper left", "middle"), in reading order.
std::vector<std::string> empty_parts(const calibration::Coverage& coverage);

/// The standard deviation of the distance between the cameras.
double baseline_deviation_mm(const calibration::StereoCalibration& calibration);

} // namespace dicot::app
