// Which pairs show a target, how far away it was, and where it is in the left picture.
#pragma once

#include "../calibrate/pair_files.h"

#include "dicot/base/status.h"
#include "dicot/base/stereo_rig.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace dicot::app {

/// x, y, width and height in the left picture as the camera gave it, px.
using TargetBox = std::array<int, 4>;

/// A plane in the frame of the left camera, mm.
struct Plane
{
    Point3 normal; ///< need not have length 1
    Point3 point;
};

struct Target
{
    std::string name; ///< for tables
    std::string left_path;
    std::string right_path;
    double distance_mm = 0;          ///< along the optical axis of the left camera, from its projection centre
    std::array<Point2, 4> corners{}; ///< of what is measured, going round, px of the left picture as the camera gave it
    std::optional<Plane> plane = {}; ///< of a target that is not parallel to the left picture
};

struct TargetList
{
    std::vector<Target> targets;    ///< from near to far
    std::vector<LonePicture> alone; ///< pictures that nothing is done with, and why
    std::string source;             ///< the table's path; empty when the names of the pictures told
};

struct TargetWords
{
    std::string folder;
    std::string table;            ///< empty: the one that the folder holds, if it does
    std::optional<TargetBox> box; ///< of every left picture
};

/// How much of a target's width and height is measured, about its middle, where the table tells its corners: at the rim
/// a matcher sees the background too.
inline constexpr double kInnerShare = 0.8;
/// Side of what is measured in the middle of the picture, as a share of the picture's, where nothing else is told.
inline constexpr double kMiddleShare = 1.0 / 12;

/// The targets of a folder, as the command's help says. Fault::kNoInput: no folder, no pictures, no pair; kBadData: a
/// table with a cell that is no number, without a column that it needs, without rows, or whose pictures do not exist;
/// a name without a distance; pictures of different sizes; kUsage: several tables to choose from, or a box outside of
/// the pictures.
Result<TargetList> list_targets(const TargetWords& words);

/// The distance that a name tells, mm: its number before "mm" or "cm", else its only number, which is mm; a number of
/// the camera (cam0) does not count. Nothing where that is not clear.
std::optional<double> distance_in_name(const std::string& left_name);

} // namespace dicot::app
