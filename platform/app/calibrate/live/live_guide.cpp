#include "live_guide.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace dicot::app {
namespace {

using calibration::Board;
using calibration::BoardSight;
using calibration::Stance;
using calibration::WorkingRange;

// Two boards are alike when all of these are less apart.
constexpr double kPlaceApart = 0.08;    // of the picture's width and height
constexpr double kDistanceApart = 0.10; // of the distance
constexpr double kSlopeApart = 0.15;    // 8.5 degrees

bool alike(const Stance& a, const Stance& b)
{
    const auto near = [](const Point2& p, const Point2& q, double apart) {
        return std::abs(p.x - q.x) < apart && std::abs(p.y - q.y) < apart;
    };
    return near(a.place, b.place, kPlaceApart) && near(a.slope, b.slope, kSlopeApart) &&
           std::abs(a.distance_mm - b.distance_mm) < kDistanceApart * b.distance_mm;
}

} // namespace

const char* name_of(LiveSight sight)
{
    switch (sight) {
    case LiveSight::kUnseen:
        return "unseen";
    case LiveSight::kLeftUnseen:
        return "left unseen";
    case LiveSight::kRightUnseen:
        return "right unseen";
    case LiveSight::kUnclear:
        return "unclear";
    case LiveSight::kMoving:
        return "moving";
    case LiveSight::kAlike:
        return "alike";
    case LiveSight::kTake:
        return "taken";
    }
    return "";
}

LiveGuide::LiveGuide(const Board& board, int width, int height, const WorkingRange& range, int pairs)
    : board_(board), width_(width), height_(height), range_(range), wanted_(std::clamp(pairs, 1, kMostPairs)),
      focal_px_(calibration::guess_focal_px(board, {}, width, height)), stillness_(width, board.corner_count())
{
    lefts_.reserve(static_cast<std::size_t>(wanted_));
    stances_.reserve(static_cast<std::size_t>(wanted_));
}

Stance LiveGuide::stance(const std::vector<Point2>& corners) const
{
    return calibration::stance_of(board_, corners, width_, height_, focal_px_);
}

int LiveGuide::twin_of(const Stance& now) const
{
    const auto found = std::ranges::find_if(stances_, [&](const Stance& kept) { return alike(now, kept); });
    return found == stances_.end() ? 0 : static_cast<int>(found - stances_.begin()) + 1;
}

LiveSight LiveGuide::judge(const BoardSight& left, BoardSight& right, std::int64_t at_us)
{
    if (!left.found && !right.found) {
        advice_ =
            "show the whole board to both cameras, " + next_place(coverage_, range_, {}) + " (" + left.reason + ")";
        return LiveSight::kUnseen;
    }
    if (!left.found) {
        advice_ = "the left camera does not see the whole board: " + left.reason;
        return LiveSight::kLeftUnseen;
    }
    if (!right.found) {
        advice_ = "the right camera does not see the whole board: " + right.reason;
        return LiveSight::kRightUnseen;
    }
    if (const Status agreed = calibration::agree_on_order(board_, left, right); !agreed.ok()) {
        advice_ = agreed.message();
        return LiveSight::kUnclear;
    }
    last_left_ = left.corners;
    last_right_ = right.corners;
    const bool still = stillness_.see(left.corners, right.corners, at_us);
    const Stance now = stance(left.corners);
    if (const int twin = twin_of(now); twin > 0) {
        advice_ = "hold the board " + next_place(coverage_, range_, now) + " (now it is as in pair " +
                  std::to_string(twin) + ")";
        return still ? LiveSight::kAlike : LiveSight::kMoving;
    }
    advice_ = still ? "this pair is taken"
                    : "hold still for this pair, or hold the board " + next_place(coverage_, range_, now);
    return still ? LiveSight::kTake : LiveSight::kMoving;
}

LiveSight LiveGuide::see(const BoardSight& left, BoardSight right, std::int64_t at_us)
{
    const LiveSight sight = judge(left, right, at_us);
    if (sight < LiveSight::kMoving)
        stillness_.lose();
    return sight;
}

void LiveGuide::keep()
{
    lefts_.push_back(last_left_);
    calibration::add_corners(coverage_.left, last_left_, width_, height_);
    calibration::add_corners(coverage_.right, last_right_, width_, height_);
    // Every pair tells more of the focal length, and with it of all distances and tilts.
    focal_px_ = calibration::guess_focal_px(board_, lefts_, width_, height_);
    stances_.clear();
    coverage_.by_distance = {};
    coverage_.by_edge = {};
    for (const std::vector<Point2>& corners : lefts_) {
        stances_.push_back(stance(corners));
        add_pair(coverage_, stances_.back(), range_);
    }
}

} // namespace dicot::app
