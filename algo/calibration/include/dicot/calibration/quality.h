// How far a calibration can be trusted, in millimetres.
#pragma once

#include "dicot/calibration/solve.h"

#include <string>
#include <vector>

namespace dicot::calibration {

struct WorkingRange
{
    double near_mm = 400;
    double far_mm = 1200;
};

/// What to expect of a depth at one distance (standard deviations, root mean square over the part of the left picture
/// that the right camera sees too).
struct DepthError
{
    double distance_mm = 0;
    double calibration_mm = 0; ///< from the covariance of the calibration: a bend of space, the same in every picture
    double corner_mm = 0;      ///< of one board corner: its own noise of sigma_px on top
};

constexpr int kCoverageCols = 8;
constexpr int kCoverageRows = 6;
constexpr int kDistanceBins = 3;

/// Corners of the used views by cell of the picture, row after row.
struct Coverage
{
    std::array<int, kCoverageCols * kCoverageRows> corners{};
    double share = 0; ///< of the cells, those with at least one corner
};

/// Counts corners of a picture of `width` x `height` px; those outside count for the nearest cell.
void add_corners(Coverage& coverage, std::span<const Point2> corners, int width, int height);

enum class Verdict
{
    kGood,
    kUsable,
    kRedo
};
const char* name_of(Verdict verdict);

/// Up to where a number is good, and up to where it is usable; beyond, the verdict is kRedo.
template <typename Number>
struct Gate
{
    Number good;
    Number usable;
};
constexpr Gate<double> kEpipolarGate_px{0.25, 0.6};
/// Of the distance: the expected depth error at the far end of the working range, and the size of held-out boards.
constexpr Gate<double> kDepthGate_percent{0.3, 1.5};
constexpr Gate<int> kPairsGate{10, 6};
constexpr Gate<double> kCoverageGate{0.55, 0.25}; ///< share of the cells, of the thinner picture

struct Quality
{
    /// Pairs that a solution without them triangulates (at most kFolds solutions): distance of the corners from the
    /// true board after the best rigid fit; root mean square.
    double held_out_mm = 0;
    /// The same pairs: how much larger or smaller the board comes out, times its distance; root mean square. What a
    /// wrong angle between the cameras does to depth shows here.
    double held_out_depth_mm = 0;
    double held_out_size_percent = 0;
    int held_out_pairs = 0;

    double epipolar_rms_px = 0;
    double epipolar_p95_px = 0;

    std::vector<DepthError> depth; ///< at 500, 800 and 1000 mm
    DepthError depth_at_far;       ///< at the far end of the working range

    Coverage left;
    Coverage right;
    double nearest_mm = 0; ///< used corners, distance along the left camera's axis
    double farthest_mm = 0;
    std::array<int, kDistanceBins> boards_by_distance{}; ///< near, middle and far third of the working range

    Verdict verdict = Verdict::kRedo;
    std::vector<std::string> advice; ///< what to do next, most important first; empty when good
};

constexpr int kFolds = 5;

Quality assess(const CalibrationTask& task, const StereoCalibration& calibration, const WorkingRange& range);

/// The expected error of depths at `distance_mm`.
DepthError predict_depth_error(const StereoCalibration& calibration, double distance_mm);

} // namespace dicot::calibration
