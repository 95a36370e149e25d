#include "dicot/calibration/stance.h"

#include "closed_form.h"
#include "grey_level.h"

#include <algorithm>

namespace dicot::calibration {

namespace {

constexpr double kWebcamFocal = 0.85;  // of the picture's width: 61 degrees across
constexpr double kShortestFocal = 0.5; // 90 degrees
constexpr double kLongestFocal = 2;    // 28 degrees
constexpr int kLargeSide_px = 1000;    // from which on the half is searched first

} // namespace

double guess_focal_px(const Board& board, std::span<const std::vector<Point2>> sights, int width, int height)
{
    if (sights.size() < kFewestForFocal)
        return kWebcamFocal * width;
    std::vector<Eigen::Matrix3d> homographies;
    homographies.reserve(sights.size());
    for (const std::vector<Point2>& corners : sights)
        homographies.push_back(board_homography(board, corners));
    const LensVector lens = lens_from_homographies(homographies, width, height);
    return std::clamp(0.5 * (lens[0] + lens[1]), kShortestFocal * width, kLongestFocal * width);
}

Stance stance_of(const Board& board, std::span<const Point2> corners, int width, int height, double focal_px)
{
    LensVector lens = LensVector::Zero();
    lens.head<4>() << focal_px, focal_px, 0.5 * (width - 1), 0.5 * (height - 1);
    const Pose pose = pose_from_homography(lens, board_homography(board, corners));
    const Eigen::Vector3d normal = pose.turn * Eigen::Vector3d::UnitZ();

    Stance stance;
    stance.distance_mm = pose.shift.z();
    // A board seen from its edge has no slope; found ones are never tilted that far.
    const double away = std::max(normal.z(), 1e-3);
    stance.slope = {-normal.x() / away, -normal.y() / away};
    for (const Point2& corner : corners) {
        stance.place.x += (corner.x + 0.5) / width / static_cast<double>(corners.size());
        stance.place.y += (corner.y + 0.5) / height / static_cast<double>(corners.size());
    }
    return stance;
}

BoardSight glance(ImageView<const std::uint8_t> grey, const Board& board)
{
    if (std::max(grey.width, grey.height) >= kLargeSide_px) {
        const GreyPicture half = halve(grey);
        BoardSight sight = find_board(half.view(), board);
        if (sight.found) {
            for (Point2& corner : sight.corners)
                corner = {2 * corner.x + 0.5, 2 * corner.y + 0.5};
            sight.square_px *= 2;
            return sight;
        }
    }
    return find_board(grey, board);
}

} // namespace dicot::calibration
