// The calibration pictures made worse: boards are still found, and the rig stays where the plain pictures put it.
#include "calibration_data.h"
#include "worse_pictures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dicot {
namespace {

using calibration::CalibrationTask;
using calibration::StereoCalibration;
using test::GreyPicture;
using test::PairSet;
using test::PicturePair;

struct WorseSet
{
    const char* name;
    PairSet pairs;
    std::size_t pair_count;
    double shift_limit_mm; ///< each axis of T may move so far
};

struct Change
{
    const char* name;
    void (*worsen)(GreyPicture& picture, std::mt19937& random);
};

constexpr Change kPlain{"as they are", [](GreyPicture&, std::mt19937&) {}};
constexpr Change kChanges[] = {
    {"shadow over half, 35 % of the light", test::shade_half},
    {"300 spots of dirt", test::sprinkle_dirt},
    {"a tenth of the light, noise of 2", test::dim},
    {"blur of 4 px", test::blur},
};

struct Outcome
{
    int found = 0;
    std::optional<StereoCalibration> solved;
};

Outcome calibrated(const WorseSet& set, const std::vector<PicturePair>& pairs, const Change& change, unsigned seed)
{
    Outcome outcome;
    CalibrationTask task;
    task.boards = {set.pairs.board};
    task.width = pairs[0].left.width;
    task.height = pairs[0].left.height;
    std::mt19937 random(seed);
    for (PicturePair pair : pairs) {
        change.worsen(pair.left, random);
        change.worsen(pair.right, random);
        const auto left = calibration::find_board(pair.left.view(), set.pairs.board);
        auto right = calibration::find_board(pair.right.view(), set.pairs.board);
        outcome.found += left.found + right.found;
        for (const auto& [side, sight] : {std::pair{"left", &left}, {"right", &right}})
            if (!sight->found)
                std::printf("  %s, %s %02d: %s\n", change.name, side, pair.number, sight->reason.c_str());
        if (!left.found || !right.found)
            continue;
        const Status order = calibration::agree_on_order(set.pairs.board, left, right);
        EXPECT_TRUE(order.ok()) << change.name << ", pair " << pair.number << ": " << order.message();
        if (order.ok())
            task.views.push_back({0, left.corners, right.corners});
    }
    auto solved = solve_stereo(task);
    EXPECT_TRUE(solved.ok()) << change.name << ": " << solved.status().message();
    if (solved.ok())
        outcome.solved = std::move(solved).value();
    return outcome;
}

void print(const WorseSet& set, const Change& change, const Outcome& outcome)
{
    const Point3& t = outcome.solved->rig.shift_mm;
    std::printf("| %-19s | %-35s | %2d of %2zu | %8.3f %6.3f %6.3f | %6.3f |\n", set.name, change.name, outcome.found,
                2 * set.pair_count, t.x, t.y, t.z, outcome.solved->rms_px);
}

class WorsePictures : public testing::TestWithParam<WorseSet>
{
};

TEST_P(WorsePictures, HardlyMoveTheRig)
{
    const WorseSet& set = GetParam();
    if (!test::data_there(set.pairs.folder))
        return;
    const std::vector<PicturePair> pairs = test::pictures_of(set.pairs);
    ASSERT_EQ(pairs.size(), set.pair_count);
    std::printf("| %-19s | %-35s | %-8s | %-22s | %-6s |\n", "worse pictures", "made worse by", "boards", "T mm",
                "RMS px");
    const Outcome plain = calibrated(set, pairs, kPlain, 0);
    ASSERT_TRUE(plain.solved);
    print(set, kPlain, plain);
    const Point3& before = plain.solved->rig.shift_mm;
    const int pictures = 2 * static_cast<int>(set.pair_count);
    unsigned seed = 1;
    for (const Change& change : kChanges) {
        SCOPED_TRACE(std::string(change.name) + ", seed " + std::to_string(seed));
        const Outcome worse = calibrated(set, pairs, change, seed++);
        ASSERT_TRUE(worse.solved);
        print(set, change, worse);
        EXPECT_GE(20 * worse.found, 19 * pictures);
        const Point3& after = worse.solved->rig.shift_mm;
        EXPECT_NEAR(after.x, before.x, set.shift_limit_mm);
        EXPECT_NEAR(after.y, before.y, set.shift_limit_mm);
        EXPECT_NEAR(after.z, before.z, set.shift_limit_mm);
    }
}

INSTANTIATE_TEST_SUITE_P(Sets, WorsePictures,
                         testing::Values(WorseSet{"real pairs", test::kOpenCvPairs, 13, 0.4},
                                         WorseSet{"rendered, 9 x 9", test::kBoard10, 20, 0.08},
                                         WorseSet{"rendered, 7 x 7", test::kBoard8, 20, 0.08}),
                         [](const auto& set) {
                             return set.param.pair_count == 13        ? "Real"
                                    : set.param.pairs.board.cols == 9 ? "Board10"
                                                                      : "Board8";
                         });

} // namespace
} // namespace dicot
