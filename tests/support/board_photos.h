// Photographs of a small rig before a board, as files that a calibration reads.
#pragma once

#include "rig_scene.h"
#include "temp_folder.h"

#include <array>
#include <fstream>
#include <string>
#include <vector>

namespace dicot::test {

inline constexpr Board kBoard{7, 5, 30};
inline const std::string kBoardWords = " --corners 7x5 --square-mm 30 ";

/// Two small cameras, so that pictures of them are quickly made.
inline StereoRig small_rig()
{
    StereoRig rig;
    rig.width = 400;
    rig.height = 300;
    rig.left = {330, 331, 201, 148, {}};
    rig.right = {332, 331, 197, 152, {}};
    rig.turn = turn_about(-0.8, 0.5, -0.6);
    rig.shift_mm = {-60, 0.7, 0.9};
    return rig;
}

/// One camera's picture of a board.
inline void photograph_to(const std::string& path, const StereoRig& rig, bool right, const Board& board,
                          const Placement& place)
{
    Scene scene;
    scene.board = board;
    scene.place = right ? in_right(rig, place) : place;
    scene.lens = right ? rig.right : rig.left;
    scene.width = rig.width;
    scene.height = rig.height;
    const Photo photo = photograph(scene);
    std::ofstream file(path, std::ios::binary);
    file << "P5 " << photo.width << " " << photo.height << " 255\n";
    for (const std::uint8_t pixel : photo.pixels)
        file.put(static_cast<char>(pixel));
}

/// Distances at which the board fills a good part of the picture, tilted to all sides.
inline std::vector<Placement> varied_places()
{
    std::vector<Placement> places;
    for (const auto& [tilt_x, tilt_y, x, y, z] : std::vector<std::array<double, 5>>{{25, 0, -60, -40, 420},
                                                                                    {-25, 5, 90, 40, 430},
                                                                                    {0, 30, 60, -50, 460},
                                                                                    {5, -30, -50, 60, 450},
                                                                                    {20, 20, 130, 90, 640},
                                                                                    {-20, 25, -100, -80, 600},
                                                                                    {-25, -25, 20, 0, 500}})
        places.push_back({turn_about(tilt_x, tilt_y, 0.2 * x), {x + 25, y, z}});
    return places;
}

inline void photograph_pairs(const TempFolder& folder, const std::vector<Placement>& places, const char* left = "left",
                             const char* right = "right")
{
    const StereoRig rig = small_rig();
    for (std::size_t k = 0; k < places.size(); ++k) {
        const std::string number = std::to_string(k + 1) + ".pgm";
        photograph_to(folder.path(left + number), rig, false, kBoard, places[k]);
        photograph_to(folder.path(right + number), rig, true, kBoard, places[k]);
    }
}

} // namespace dicot::test
