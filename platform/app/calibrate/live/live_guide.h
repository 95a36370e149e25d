// Leads a person with a chessboard through the pairs that a calibration wants. No pictures, no cameras, no clock: it
// is told what was seen, and when.
#pragma once

#include "live_coverage.h"
#include "stillness.h"

#include <cstdint>
#include <string>
#include <vector>

namespace dicot::app {

/// What a pair was good for.
enum class LiveSight
{
    kUnseen,      ///< neither picture shows the whole board
    kLeftUnseen,  ///< the right one alone does
    kRightUnseen, ///< the left one alone does
    kUnclear,     ///< nobody can tell which corner is which
    kMoving,
    kAlike, ///< it stands still where it stood in a pair that was taken
    kTake   ///< still, and new
};
const char* name_of(LiveSight sight);

class LiveGuide
{
public:
    static constexpr int kMostPairs = 200;

    /// Wants `pairs` pairs, 1 .. kMostPairs, of pictures of `width` x `height` px. Takes its memory here.
    LiveGuide(const calibration::Board& board, int width, int height, const calibration::WorkingRange& range,
              int pairs);

    /// What to make of a pair, and sets advice(). `at_us` is the pair's time by a clock that does not jump. Most work
    /// goes with the number of pairs taken.
    LiveSight see(const calibration::BoardSight& left, calibration::BoardSight right, std::int64_t at_us);
    /// The last pair seen has been taken: the one for which see() said kTake, or one of an earlier run, which shows the
    /// board in both pictures.
    void keep();

    /// As many pairs as were wanted.
    bool done() const { return kept() >= wanted_; }
    int kept() const { return static_cast<int>(lefts_.size()); }
    int wanted() const { return wanted_; }
    const LiveCoverage& coverage() const { return coverage_; }
    std::int64_t still_us() const { return stillness_.still_us(); }
    /// One sentence without a full stop: what to do next.
    const std::string& advice() const { return advice_; }

private:
    calibration::Stance stance(const std::vector<Point2>& corners) const;
    /// Number of the kept pair that looks the same, from 1; 0: none does.
    int twin_of(const calibration::Stance& now) const;
    LiveSight judge(const calibration::BoardSight& left, calibration::BoardSight& right, std::int64_t at_us);

    calibration::Board board_;
    int width_;
    int height_;
    calibration::WorkingRange range_;
    int wanted_;
    double focal_px_;
    Stillness stillness_;
    std::vector<Point2> last_left_; ///< of the last pair that showed the board twice
    std::vector<Point2> last_right_;
    std::vector<std::vector<Point2>> lefts_; ///< of the pairs taken
    std::vector<calibration::Stance> stances_;
    LiveCoverage coverage_;
    std::string advice_;
};

} // namespace dicot::app
