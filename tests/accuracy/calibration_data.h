// The calibration pictures of the data folder, and the truth about them.
#pragma once

#include "dicot/calibration/grey.h"
#include "dicot/calibration/solve.h"
#include "dicot/picture/read_picture.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace dicot::test {

using calibration::Board;
using calibration::BoardSight;
using calibration::CalibrationTask;

inline std::string data_path(const std::string& inner)
{
    return std::string(DICOT_DATA_DIR) + "/" + inner;
}

/// Says in one line what is not run when the data are absent.
inline bool data_there(const std::string& inner)
{
    if (std::filesystem::is_directory(data_path(inner)))
        return true;
    std::printf("NOT RUN: %s is not there\n", data_path(inner).c_str());
    return false;
}

struct GreyPicture
{
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;

    ImageView<std::uint8_t> view() { return {pixels.data(), width, height}; }
};

inline Result<GreyPicture> grey_picture(const std::string& path)
{
    const PictureSize size = TRY(picture_size(path.c_str()));
    std::vector<Rgb8> colour(static_cast<std::size_t>(size.pixels()));
    GreyPicture grey{size.width, size.height, std::vector<std::uint8_t>(colour.size())};
    const ImageView<Rgb8> view{colour.data(), size.width, size.height};
    TRY(read_picture(path.c_str(), view));
    calibration::to_grey(view, grey.view());
    return grey;
}

inline Result<BoardSight> sight_in(const std::string& path, const Board& board, int& width, int& height)
{
    GreyPicture grey = TRY(grey_picture(path));
    width = grey.width;
    height = grey.height;
    return calibration::find_board(grey.view(), board);
}

struct PairSet
{
    const char* folder;
    Board board;
    const char* separator; ///< between the side's name and the number
    int first;
    int last;
    int missing = -1;

    std::string path(std::size_t side, int number) const
    {
        char name[64];
        std::snprintf(name, sizeof name, "/%s%s%02d.jpg", side == 0 ? "left" : "right", separator, number);
        return data_path(folder) + name;
    }
};

inline const PairSet kOpenCvPairs{"calibration-opencv", {9, 6, 30}, "", 1, 14, 10};
inline const PairSet kBoard10{"rig-dev/calibration/board10x10_41mm", {9, 9, 41}, "_", 0, 19};
inline const PairSet kBoard8{"rig-dev/calibration/board8x8_46mm", {7, 7, 46}, "_", 0, 19};

struct PicturePair
{
    int number = 0;
    GreyPicture left;
    GreyPicture right;
};

/// All pairs of a set; one that cannot be read fails the test.
inline std::vector<PicturePair> pictures_of(const PairSet& set)
{
    std::vector<PicturePair> pairs;
    for (int number = set.first; number <= set.last; ++number) {
        if (number == set.missing)
            continue;
        auto left = grey_picture(set.path(0, number)), right = grey_picture(set.path(1, number));
        EXPECT_TRUE(left.ok()) << left.status().message();
        EXPECT_TRUE(right.ok()) << right.status().message();
        if (left.ok() && right.ok())
            pairs.push_back({number, std::move(left).value(), std::move(right).value()});
    }
    return pairs;
}

/// Adds all pairs of a set; returns how many pictures showed no board, and prints why.
inline int add_pairs(const PairSet& set, CalibrationTask& task)
{
    task.boards.push_back(set.board);
    int missed = 0;
    for (int number = set.first; number <= set.last; ++number) {
        if (number == set.missing)
            continue;
        std::array<BoardSight, 2> sight;
        for (const std::size_t side : {0U, 1U}) {
            const std::string path = set.path(side, number);
            auto seen = sight_in(path, set.board, task.width, task.height);
            if (!seen.ok() || !seen.value().found) {
                std::printf("%s: %s\n", path.c_str(),
                            seen.ok() ? seen.value().reason.c_str() : seen.status().message());
                ++missed;
                continue;
            }
            sight[side] = std::move(seen).value();
        }
        if (!sight[0].found || !sight[1].found)
            continue;
        const Status order = calibration::agree_on_order(set.board, sight[0], sight[1]);
        if (!order.ok()) {
            std::printf("%s %02d: %s\n", set.folder, number, order.message());
            ++missed;
            continue;
        }
        task.views.push_back({static_cast<int>(task.boards.size()) - 1, sight[0].corners, sight[1].corners});
    }
    return missed;
}

/// A rig as it was rendered, from its gt_calib*.json.
inline StereoRig true_rig(const std::string& inner)
{
    const auto json = nlohmann::json::parse(std::ifstream(data_path(inner)));
    const auto lens = [&](const char* k, const char* d) {
        Lens l{json[k][0][0], json[k][1][1], json[k][0][2], json[k][1][2], {}};
        for (std::size_t i = 0; i < 5; ++i)
            l.k[i] = json[d][i];
        return l;
    };
    StereoRig rig;
    rig.width = json["image_size"][0];
    rig.height = json["image_size"][1];
    rig.left = lens("K1", "D1");
    rig.right = lens("K2", "D2");
    for (std::size_t i = 0; i < 9; ++i)
        rig.turn[i] = json["R"][i / 3][i % 3];
    rig.shift_mm = {json["t_mm"][0], json["t_mm"][1], json["t_mm"][2]};
    return rig;
}

inline StereoRig rig_dev_truth()
{
    return true_rig("rig-dev/calibration/gt_calib.json");
}

} // namespace dicot::test
