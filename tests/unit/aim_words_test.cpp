// What dicot aim says of figures that are given.
#include "aim/aim_advice.h"
#include "aim/aim_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sstream>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

AimSide good_side()
{
    AimSide side;
    aiming::Focus focus;
    focus.whole = 55;
    focus.region.fill(55);
    focus.edges = 9000;
    side.see(focus, {118, 0.4});
    side.frames_per_s = 30;
    return side;
}

AimMoment good_moment()
{
    AimMoment now;
    now.elapsed_s = 12.3;
    now.width = 640;
    now.height = 480;
    now.pairs = 180;
    now.left = now.right = good_side();
    now.views = {.matches = 200,
                 .patches = 700,
                 .shift_px = 40,
                 .shift_low_px = 20,
                 .shift_high_px = 60,
                 .vertical_px = 3,
                 .roll_deg = 0.3,
                 .overlap_percent = 93,
                 .order = aiming::Order::kAsNamed};
    now.skew_us = 1200;
    return now;
}

TEST(AimAdvice, NothingIsToBeDoneIfAllIsWell)
{
    EXPECT_THAT(aim_advice(good_moment()), IsEmpty());
}

TEST(AimAdvice, SwappedCamerasComeFirst)
{
    AimMoment now = good_moment();
    now.views.order = aiming::Order::kSwapped;
    now.left.light.mean_luma = 10;
    EXPECT_THAT(aim_advice(now), ElementsAre(HasSubstr("left and right are swapped"), HasSubstr("left: too dark")));
}

TEST(AimAdvice, ACameraIsTurnedBackAgainstItsTurn)
{
    AimMoment now = good_moment();
    now.views.roll_deg = 1.2;
    EXPECT_THAT(aim_advice(now), ElementsAre("turn the right camera 1.2 degrees counter-clockwise, seen from behind"));
    now.views.roll_deg = -2.5;
    EXPECT_THAT(aim_advice(now), ElementsAre("turn the right camera 2.5 degrees clockwise, seen from behind"));
    now.views.matches = kMatchesForRoll - 1;
    EXPECT_THAT(aim_advice(now), IsEmpty());
}

TEST(AimAdvice, ACameraThatLooksTooHighIsTiltedDown)
{
    AimMoment now = good_moment();
    now.views.vertical_px = 22; // what it sees lies lower in its picture
    EXPECT_THAT(aim_advice(now), ElementsAre(HasSubstr("tilt the right camera down")));
    now.views.vertical_px = -22;
    EXPECT_THAT(aim_advice(now), ElementsAre(HasSubstr("tilt the right camera up")));
}

TEST(AimAdvice, LightIsNamedWithItsShare)
{
    AimMoment now = good_moment();
    now.right.light = {150, 12.2};
    EXPECT_THAT(aim_advice(now), ElementsAre(testing::AllOf(HasSubstr("right: too bright"), HasSubstr("12 %"))));
    now.right.light = {kLeastLuma - 1, 0};
    EXPECT_THAT(aim_advice(now), ElementsAre(HasSubstr("right: too dark")));
}

TEST(AimAdvice, ALensThatWasBetterIsTurnedBack)
{
    AimMoment now = good_moment();
    aiming::Focus focus = now.left.focus;
    focus.whole = 30;
    now.left.see(focus, now.left.light);
    EXPECT_THAT(aim_advice(now), ElementsAre("left: was sharper (55, now 30): turn its lens back"));
    now.left.best_focus = 32;
    EXPECT_THAT(aim_advice(now), ElementsAre(HasSubstr("left: not sharp (30; 40 is)")));
}

TEST(AimAdvice, LittleInCommonIsSaidOnlyOfGoodPictures)
{
    AimMoment now = good_moment();
    now.views = {};
    EXPECT_THAT(aim_advice(now), ElementsAre(HasSubstr("too little in common")));
    now.left.light.mean_luma = 3;
    EXPECT_THAT(aim_advice(now), ElementsAre(HasSubstr("too dark")));
}

TEST(AimAdvice, OverlapSkewAndTornFramesAreNamed)
{
    AimMoment now = good_moment();
    now.views.overlap_percent = 50;
    now.skew_us = -14'000;
    now.left.torn = 7;
    EXPECT_THAT(aim_advice(now), ElementsAre(HasSubstr("share only 50 %"), HasSubstr("14.0 ms apart"),
                                             HasSubstr("left: 7 of its frames came torn")));
    now.one_at_a_time = true;
    EXPECT_THAT(aim_advice(now), Not(testing::Contains(HasSubstr("apart, and"))));
}

AimMoment worst_moment()
{
    AimMoment now = good_moment();
    now.views.order = aiming::Order::kSwapped;
    now.views.roll_deg = -11.2;
    now.views.vertical_px = -57;
    now.views.overlap_percent = 41;
    now.left.light = now.right.light = {251, 88.8};
    now.left.torn = now.right.torn = now.left.lost = now.right.lost = 9999;
    now.left.best_focus = now.right.best_focus = 100;
    now.skew_us = -1'234'567;
    return now;
}

std::vector<std::string> lines_of(const std::string& block)
{
    std::vector<std::string> lines;
    std::istringstream stream(block);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

TEST(AimBlock, NoLineIsWiderThanTheTerminal)
{
    for (const int columns : {10, 40, 60, 79, 200})
        for (const AimMoment& now : {good_moment(), worst_moment(), AimMoment{}})
            for (const std::string& line : lines_of(aim_block(now, columns, false)))
                EXPECT_LE(line.size(), static_cast<std::size_t>(columns)) << line;
}

TEST(AimBlock, SixtyColumnsHoldEveryFigure)
{
    const std::string block = aim_block(good_moment(), 60, false);
    EXPECT_EQ(block, aim_block(good_moment(), 200, false));
    for (const char* part : {"55 sharp, best 55", "[###########|........]", "118 good", "0.4 %", "30.0 /s", "93 %",
                             "3 px lower", "0.3 degrees clockwise", "left is left", "1.2 ms", "all is well"})
        EXPECT_THAT(block, HasSubstr(part));
}

TEST(AimBlock, WrappedAdviceLosesNoWord)
{
    std::string words;
    bool advice = false;
    for (const std::string& line : lines_of(aim_block(worst_moment(), 60, false))) {
        advice = advice || line.starts_with("> ");
        if (advice)
            words += (line.starts_with("> ") ? "\n" : " ") + line.substr(2);
    }
    for (const std::string& sentence : aim_advice(worst_moment()))
        EXPECT_THAT(words + "\n", HasSubstr("\n" + sentence + "\n"));
}

TEST(AimBlock, ColoursChangeNoLetter)
{
    const std::string coloured = aim_block(worst_moment(), 60, true);
    EXPECT_THAT(coloured, HasSubstr("\033[31m"));
    std::string plain;
    for (std::size_t i = 0; i < coloured.size(); ++i) {
        if (coloured[i] == '\033')
            i = coloured.find('m', i);
        else
            plain += coloured[i];
    }
    EXPECT_EQ(plain, aim_block(worst_moment(), 60, false));
}

TEST(AimJson, IsOneLineWithNullForWhatIsNotKnown)
{
    const std::string line = aim_json(good_moment());
    EXPECT_EQ(line.find('\n'), std::string::npos);
    const nlohmann::json good = nlohmann::json::parse(line);
    EXPECT_EQ(good["left"]["focus"], 55);
    EXPECT_EQ(good["views"]["order"], "as named");
    EXPECT_DOUBLE_EQ(good["views"]["roll_deg"].get<double>(), 0.3);
    EXPECT_EQ(good["skew_us"], 1200);
    EXPECT_TRUE(good["advice"].empty());

    AimMoment blind;
    blind.one_at_a_time = true;
    const nlohmann::json none = nlohmann::json::parse(aim_json(blind));
    for (const char* key : {"shift_px", "vertical_px", "roll_deg", "overlap_percent"})
        EXPECT_TRUE(none["views"][key].is_null()) << key;
    EXPECT_TRUE(none["left"]["focus"].is_null());
    EXPECT_TRUE(none["right"]["frames_per_s"].is_null());
    EXPECT_TRUE(none["skew_us"].is_null());
    EXPECT_EQ(none["views"]["order"], "not known");
}

TEST(Light, CountsPixelsOfWhichOneChannelIsFull)
{
    std::vector<Rgb8> colours(8, Rgb8{40, 40, 40});
    colours[1] = {255, 0, 0};
    colours[6] = {10, 20, 250};
    colours[7] = {249, 249, 249};
    const std::vector<std::uint8_t> greys{40, 76, 40, 40, 40, 40, 43, 249};
    const Light light = light_of({colours.data(), 4, 2}, {greys.data(), 4, 2});
    EXPECT_DOUBLE_EQ(light.saturated_percent, 25);
    EXPECT_EQ(light.mean_luma, 71);
}

} // namespace
} // namespace dicot::app
