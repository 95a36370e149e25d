// A stereo rig before boards, and the corners that it would see.
#pragma once

#include "board_scene.h"

#include "dicot/calibration/solve.h"

namespace dicot::test {

using calibration::CalibrationTask;
using calibration::View;

inline StereoRig webcam_rig()
{
    StereoRig rig;
    rig.width = 1280;
    rig.height = 720;
    rig.left = {780, 782, 641, 355, {-0.11, 0.045, 0.0008, -0.0009, 0}};
    rig.right = {786, 785, 634, 364, {-0.13, 0.030, -0.0006, 0.0011, 0}};
    rig.turn = turn_about(-1.2, 0.6, -0.9);
    rig.shift_mm = {-84.6, 1.1, 1.4};
    return rig;
}

/// The same board as seen by one of the two cameras, with normal noise.
inline std::vector<Point2> noisy_corners(const Board& board, const Placement& place, const Lens& lens, double noise_px,
                                         std::mt19937& random)
{
    std::vector<Point2> corners = board_corners(board, place, lens);
    std::normal_distribution<double> noise(0, 1);
    for (Point2& p : corners) {
        p.x += noise_px * noise(random);
        p.y += noise_px * noise(random);
    }
    return corners;
}

inline Placement in_right(const StereoRig& rig, const Placement& in_left)
{
    return {times(rig.turn, in_left.turn), rig.into_right(in_left.shift_mm)};
}

inline View view_of(const StereoRig& rig, const Board& board, int board_index, const Placement& place, double noise_px,
                    std::mt19937& random)
{
    return {board_index, noisy_corners(board, place, rig.left, noise_px, random),
            noisy_corners(board, in_right(rig, place), rig.right, noise_px, random)};
}

inline bool inside(const StereoRig& rig, const View& view)
{
    for (const std::vector<Point2>* side : {&view.left, &view.right})
        for (const Point2& p : *side)
            if (p.x < 0 || p.y < 0 || p.x > rig.width - 1 || p.y > rig.height - 1)
                return false;
    return true;
}

inline double between(double low, double high, std::mt19937& random)
{
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

inline Placement any_place(const StereoRig& rig, std::mt19937& random)
{
    const double z = between(480, 1200, random);
    return {turn_about(between(-38, 38, random), between(-38, 38, random), between(-15, 15, random)),
            {between(-0.45, 0.52, random) * z * rig.width / rig.left.fx,
             between(-0.4, 0.4, random) * z * rig.height / rig.left.fy, z}};
}

/// `pairs` boards at many distances and tilts, whole in both pictures.
inline CalibrationTask varied_task(const StereoRig& rig, const Board& board, int pairs, double noise_px,
                                   std::uint32_t seed)
{
    std::mt19937 random(seed);
    CalibrationTask task;
    task.boards = {board};
    task.width = rig.width;
    task.height = rig.height;
    while (task.views.size() < static_cast<std::size_t>(pairs)) {
        View view = view_of(rig, board, 0, any_place(rig, random), noise_px, random);
        if (inside(rig, view))
            task.views.push_back(std::move(view));
    }
    return task;
}

inline double turn_between_deg(const Turn& a, const Turn& b)
{
    double squares = 0;
    for (std::size_t k = 0; k < 9; ++k)
        squares += (a[k] - b[k]) * (a[k] - b[k]);
    return 2 * std::asin(std::sqrt(squares / 8)) * 180 / std::numbers::pi;
}

} // namespace dicot::test
