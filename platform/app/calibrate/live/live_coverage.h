// What the pairs that were taken cover, and where the board is wanted next.
#pragma once

#include "dicot/calibration/quality.h"
#include "dicot/calibration/stance.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dicot::app {

/// The edge of the board, as the left picture shows it, that is nearer to the cameras than the opposite one.
enum class NearEdge
{
    kLeft,
    kRight,
    kUpper,
    kLower
};
constexpr std::size_t kNearEdges = 4;
constexpr std::array<const char*, kNearEdges> kEdgeNames{"left", "right", "upper", "lower"};

/// From this slope on an edge counts as the nearer one: 15 degrees.
constexpr double kLeastSlope = 0.268;

/// The numbers for a screen.
struct LiveCoverage
{
    calibration::Coverage left;
    calibration::Coverage right;
    std::array<int, calibration::kDistanceBins> by_distance{}; ///< near, middle and far third of the working range
    std::array<int, kNearEdges> by_edge{};

    /// No third of either picture, no distance and no tilt is missing.
    bool full() const;
};

/// Index of the third of the working range; nothing outside of it.
std::optional<std::size_t> distance_bin(const calibration::WorkingRange& range, double distance_mm);

void add_pair(LiveCoverage& coverage, const calibration::Stance& stance, const calibration::WorkingRange& range);

/// The next place in words: distance, part of a picture and tilt, of each the first one that is missing ("nearer (400
/// to 667 mm, now about 900 mm), at the lower left of the left picture, with its upper edge nearer to the cameras
/// than its lower one"). Without `now` the present distance is not told.
std::string next_place(const LiveCoverage& coverage, const calibration::WorkingRange& range,
                       const std::optional<calibration::Stance>& now);

} // namespace dicot::app
