// What the matcher reaches on real pairs with ground truth. The figures are printed; the thresholds are the promise.
#include "matched.h"
#include "scenes.h"
#include "twin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace dicot {
namespace {

constexpr double kThresholdPx = 1.0;

MatchOptions dense(const scenes::Scene& scene, MatchMethod method, MatchCost cost)
{
    MatchOptions options;
    options.disparities = scene.disparities;
    options.method = method;
    options.cost = cost;
    options.dense = true;
    return options;
}

double mean_of_twelve(const std::vector<scenes::Scene>& all, MatchMethod method, MatchCost cost, const char* name)
{
    double sum = 0;
    std::printf("| %-20s |", name);
    for (const scenes::Scene& scene : all) {
        const Matched matched(scene.left.view(), scene.right.view(), dense(scene, method, cost));
        const scenes::ErrorRates rates = scenes::error_rates(scene, matched.map(), kThresholdPx);
        std::printf(" %5.2f %5.2f %5.2f |", rates.nonocc, rates.all, rates.disc);
        sum += rates.mean();
    }
    const double mean = sum / static_cast<double>(all.size());
    std::printf(" %5.2f |\n", mean);
    return mean;
}

TEST(MiddleburyV2, StandardBeatsThePublishedErrorAndTableOneIsPrinted)
{
    if (!scenes::data_present("MiddleburyV2.StandardBeatsThePublishedErrorAndTableOneIsPrinted"))
        return;
    const auto all = scenes::middlebury_v2();
    std::printf("error rates at %.1f px, dense: non-occluded, all, discontinuities, %%\n", kThresholdPx);
    std::printf("| %-20s |", "method, cost");
    for (const scenes::Scene& scene : all)
        std::printf(" %-17s |", scene.name.c_str());
    std::printf("  mean |\n");
    const double standard = mean_of_twelve(all, MatchMethod::kStandard, MatchCost::kAdCensus, "standard, adcensus");
    const double best = mean_of_twelve(all, MatchMethod::kBest, MatchCost::kAdCensus, "best, adcensus");
    const double standard_tad = mean_of_twelve(all, MatchMethod::kStandard, MatchCost::kTad, "standard, tad");
    const double fast = mean_of_twelve(all, MatchMethod::kFast, MatchCost::kAdCensus, "fast, adcensus");
    const double paper = mean_of_twelve(all, MatchMethod::kPaper, MatchCost::kAdCensus, "paper, adcensus");
    const double paper_tad = mean_of_twelve(all, MatchMethod::kPaper, MatchCost::kTad, "paper, tad");
    EXPECT_LE(standard, 5.6);
    EXPECT_LE(best, 4.7);
    EXPECT_LE(fast, 5.8);
    EXPECT_LE(fast, standard + 1.0);
    EXPECT_LE(paper, 8.4);
    // The paper's own finding: AD-Census beats the truncated absolute differences of plain ASW.
    EXPECT_LT(standard, standard_tad);
    EXPECT_LT(paper, paper_tad);
}

TEST(Aloe, AllButThePapersStayBelowTheSemiGlobalMatchersOnAPlant)
{
    if (!scenes::data_present("Aloe.AllButThePapersStayBelowTheSemiGlobalMatchersOnAPlant"))
        return;
    const scenes::Scene aloe = scenes::aloe_third();
    const auto rates_of = [&](MatchMethod method, const char* name) {
        const Matched matched(aloe.left.view(), aloe.right.view(), dense(aloe, method, MatchCost::kAdCensus));
        const scenes::ErrorRates rates = scenes::error_rates(aloe, matched.map(), kThresholdPx);
        std::printf("aloe-third, %s: non-occluded %.2f %%, all %.2f %%, discontinuities %.2f %%\n", name, rates.nonocc,
                    rates.all, rates.disc);
        return rates;
    };
    constexpr double kSemiGlobal = 4.2; // OpenCV's SGBM in its full mode: 4.23
    EXPECT_LE(rates_of(MatchMethod::kFast, "fast").nonocc, kSemiGlobal);
    EXPECT_LE(rates_of(MatchMethod::kStandard, "standard").nonocc, kSemiGlobal);
    EXPECT_LE(rates_of(MatchMethod::kBest, "best").nonocc, 2.7);
}

// Every kRowStep-th row: the twin does 1e9 products of doubles a second at best.
constexpr int kRowStep = 5;

TEST(Twin, IntegerWinnersDifferOnLessThanHalfAPercentAndCostNoAccuracy)
{
    if (!scenes::data_present("Twin.IntegerWinnersDifferOnLessThanHalfAPercentAndCostNoAccuracy"))
        return;
    long pixels = 0, different = 0, judged = 0, wrong_integer = 0, wrong_twin = 0;
    double worst_same = 0;
    for (const scenes::Scene& scene : scenes::middlebury_v2()) {
        MatchOptions options;
        options.disparities = scene.disparities;
        options.method = MatchMethod::kPaper;
        const Matched matched(scene.left.view(), scene.right.view(), options);
        twin::Settings settings;
        settings.disparities = scene.disparities;
        settings.gamma_color = options.gamma_color;
        settings.gamma_space = options.gamma_space;
        const twin::Pair pair(scene.left.view(), scene.right.view(), settings);
        long scene_pixels = 0, scene_different = 0;
        for (int y = kRowStep / 2; y < scene.left.height; y += kRowStep) {
            const twin::Row row = pair.match_row(y);
            for (int x = 0; x < scene.left.width; ++x) {
                const auto column = static_cast<std::size_t>(x);
                const double d = matched.map().relative.row(y)[x] / 256.0;
                const bool same = std::abs(d - row.winner[column]) <= 0.5;
                ++scene_pixels;
                scene_different += !same;
                if (same)
                    worst_same = std::max(worst_same, std::abs(d - row.disparity[column]));
                const auto i = static_cast<std::size_t>(y * scene.left.width + x);
                if (scene.nonocc[i]) {
                    ++judged;
                    wrong_integer += std::abs(d - scene.truth[i]) > kThresholdPx;
                    wrong_twin += std::abs(row.disparity[column] - scene.truth[i]) > kThresholdPx;
                }
            }
        }
        std::printf("%-8s winners differ on %.3f %% of %ld pixels\n", scene.name.c_str(),
                    100.0 * double(scene_different) / double(scene_pixels), scene_pixels);
        pixels += scene_pixels;
        different += scene_different;
    }
    const double integer_rate = 100.0 * double(wrong_integer) / double(judged);
    const double twin_rate = 100.0 * double(wrong_twin) / double(judged);
    std::printf("winners differ on %.3f %% in all; non-occluded error: integer %.3f %%, double %.3f %%; same winner: "
                "disparity differs by %.3f px at most\n",
                100.0 * double(different) / double(pixels), integer_rate, twin_rate, worst_same);
    EXPECT_LT(100.0 * double(different) / double(pixels), 0.5);
    EXPECT_LT(integer_rate, twin_rate + 0.05);
}

} // namespace
} // namespace dicot
