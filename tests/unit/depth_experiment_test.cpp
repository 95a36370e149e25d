// What names and tables say about targets, and what a fit says about errors.
#include "accuracy/csv_table.h"
#include "accuracy/error_trend.h"
#include "accuracy/face.h"
#include "accuracy/target_list.h"

#include "temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

TEST(DistanceInName, IsTheOnlyNumberOrTheOneBeforeItsUnit)
{
    EXPECT_EQ(distance_in_name("box_0488_left.jpg"), 488);
    EXPECT_EQ(distance_in_name("left/box0488.png"), 488);
    EXPECT_EQ(distance_in_name("cam0_640.5.png"), 640.5) << "a camera's number is no distance";
    EXPECT_EQ(distance_in_name("shot3_488mm_left.jpg"), 488);
    EXPECT_EQ(distance_in_name("shot3_48.8cm_left.jpg"), 488);
    EXPECT_EQ(distance_in_name("shot3_488 mm left.jpg"), 488);
    EXPECT_FALSE(distance_in_name("shot3_488_left.jpg")) << "3 or 488?";
    EXPECT_FALSE(distance_in_name("box_left.jpg"));
}

TEST(CsvTable, QuotesBlanksAndLineEndsAreThoseOfSpreadsheets)
{
    const test::TempFolder folder;
    const auto table =
        read_csv(folder.write("a.csv", std::string("\xEF\xBB\xBFname , \"x, mm\"\r\n\r\n\"a \"\"b\"\"\",1\n c,2")));
    ASSERT_TRUE(table.ok()) << table.status().message();
    EXPECT_EQ(table.value().names, (std::vector<std::string>{"name", "x, mm"}));
    ASSERT_EQ(table.value().rows.size(), 2u);
    EXPECT_EQ(table.value().rows[0], (std::vector<std::string>{"a \"b\"", "1"}));
    EXPECT_EQ(table.value().rows[1], (std::vector<std::string>{"c", "2"}));
    EXPECT_EQ(table.value().lines, (std::vector<int>{3, 4}));
    EXPECT_EQ(read_csv(folder.write("b.csv", std::string("a,b\n1\n"))).status().fault(), Fault::kBadData);
    EXPECT_EQ(read_csv(folder.write("c.csv", std::string("a,\"b\n1,2\n"))).status().fault(), Fault::kBadData);
    EXPECT_EQ(read_csv(folder.write("d.csv", std::string("\n\n"))).status().fault(), Fault::kBadData);
    EXPECT_EQ(read_csv(folder.path("gone.csv")).status().fault(), Fault::kNoInput);
}

constexpr double kDepthPxMm = 780.0 * 85;

std::vector<TrendPoint> errors(double same_mm, double share, double px)
{
    std::vector<TrendPoint> points;
    double wobble = 0.01; // px, of the matcher
    for (double z = 488; z < 1400; z += 50) {
        points.push_back({z, same_mm + share * z + (px + wobble) * z * z / kDepthPxMm, kDepthPxMm / z});
        wobble = -wobble;
    }
    return points;
}

TEST(ErrorTrend, EachCauseIsToldApartAndMeasured)
{
    const ErrorTrend same = find_trend(errors(-3, 0, 0), kDepthPxMm);
    EXPECT_EQ(same.trend, Trend::kSame);
    EXPECT_NEAR(same.amount, -3, 0.05);
    const ErrorTrend scale = find_trend(errors(0, 0.004, 0), kDepthPxMm);
    EXPECT_EQ(scale.trend, Trend::kScale);
    EXPECT_NEAR(scale.amount, 0.004, 1e-4);
    const ErrorTrend square = find_trend(errors(0, 0, 0.2), kDepthPxMm);
    EXPECT_EQ(square.trend, Trend::kSquare);
    EXPECT_NEAR(square.amount, 0.2, 0.002);
    EXPECT_NEAR(square.left_px, 0.01, 0.001);
    EXPECT_GT(square.explained, 0.99);
}

TEST(ErrorTrend, APullTowardsWholePixelsIsNoFaultOfTheRig)
{
    std::vector<TrendPoint> points = errors(0, 0, 0);
    for (TrendPoint& p : points) {
        // Nothing is lost on whole px and between two; the most, 0.125 px, a quarter away, towards the whole one.
        const double fraction = p.disparity_px - std::round(p.disparity_px);
        const double lost_px = 0.5 * std::min(std::fabs(fraction), 0.5 - std::fabs(fraction));
        p.error_mm += std::copysign(lost_px, fraction) * p.distance_mm * p.distance_mm / kDepthPxMm;
    }
    const ErrorTrend trend = find_trend(points, kDepthPxMm);
    EXPECT_EQ(trend.trend, Trend::kWhole);
    EXPECT_NEAR(trend.amount, 0.125, 0.03);
}

TEST(ErrorTrend, TheMatchersOwnErrorIsNoCause)
{
    const ErrorTrend none = find_trend(errors(0, 0, 0), kDepthPxMm);
    EXPECT_EQ(none.trend, Trend::kNone);
    EXPECT_NEAR(none.left_px, 0.01, 1e-6);
    EXPECT_EQ(find_trend(std::vector<TrendPoint>{{500, 1, 0}, {600, 1, 0}, {700, 1, 0}}, kDepthPxMm).trend,
              Trend::kTooFew);
    EXPECT_EQ(find_trend(std::vector<TrendPoint>(9, {500, 1, 0}), kDepthPxMm).trend, Trend::kTooFew);
}

TEST(DepthBound, HalfAPixelAt800MmIsTheFiveMillimetresOfThePaper)
{
    RigGeometry rig;
    rig.focal_px = 780;
    rig.baseline_mm = 85;
    // 66300 / 800 = 82.875 px; half a px less is 804.86 mm.
    EXPECT_NEAR(depth_bound_mm(rig, 800, kStepPx), 4.83, 0.005);
}

} // namespace
} // namespace dicot::app
