// The steps of method best that look at the whole map, on maps whose answers are known.
#include "edges.h"
#include "paths.h"
#include "slants.h"
#include "speckles.h"
#include "votes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace dicot::matching {
namespace {

constexpr int kWidth = 120, kHeight = 80, kDisparities = 64;

/// A map over a picture, and what the steps need beside it.
class Sheet
{
public:
    /// The picture's colour at (x, y).
    template <typename Colour>
    explicit Sheet(Colour colour) : memory_(8u << 20), arena_(memory_)
    {
        const auto take = [&]<typename Pixel>(ImageView<Pixel>& map) {
            map = {arena_.take<Pixel>(kWidth * kHeight).data(), kWidth, kHeight};
        };
        take(maps.disparity);
        take(maps.scratch);
        take(maps.confidence);
        take(maps.verdict);
        std::fill_n(maps.verdict.row(0), kWidth * kHeight, Verdict::kMatched);
        std::fill_n(maps.disparity.row(0), kWidth * kHeight, px(20));
        std::vector<Rgb8> picture;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                picture.push_back(colour(x, y));
        fill(lab_);
        planes.lay_out(arena_, kWidth, kHeight, kDisparities, 0);
        planes.fill_rows({picture.data(), kWidth, kHeight}, 0, lab_, 0, kHeight);
        weights.fill(9);
    }

    static DispQ8 px(double disparity) { return static_cast<DispQ8>(std::lround(disparity * 256)); }

    void mark(int from_x, int to_x, int from_y, int to_y, Verdict verdict)
    {
        for (int y = from_y; y < to_y; ++y)
            std::fill(maps.verdict.row(y) + from_x, maps.verdict.row(y) + to_x, verdict);
    }

    Maps maps{};
    Planes planes;
    ColourWeights weights;
    Alone crew;

private:
    std::vector<std::byte> memory_;
    Arena arena_;
    LabTables lab_;
};

Rgb8 grey(int, int)
{
    return {128, 128, 128};
}

TEST(Speckles, IslandsOfFortyPixelsStayAndSmallerOnesGo)
{
    Sheet sheet(grey);
    const auto island = [&](int x0, int y0, int pixels) {
        for (int i = 0; i < pixels; ++i)
            sheet.maps.disparity.row(y0 + i / 8)[x0 + i % 8] = Sheet::px(30);
    };
    island(10, 10, 39);
    island(40, 10, 40);
    std::vector<std::uint8_t> columns(kWidth);
    drop_speckles(sheet.maps, columns);
    int dropped = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            dropped += sheet.maps.verdict.row(y)[x] != Verdict::kMatched;
    EXPECT_EQ(dropped, 39);
    EXPECT_EQ(sheet.maps.verdict.row(10)[10], Verdict::kMismatched);
    EXPECT_EQ(sheet.maps.verdict.row(10)[40], Verdict::kMatched);
}

TEST(Clipped, MatchesAtTheRightPicturesFirstThreeColumnsAreNotBelieved)
{
    Sheet sheet(grey);
    drop_clipped(sheet.maps, 5); // partners lie 25 px to the left
    EXPECT_EQ(sheet.maps.verdict.row(40)[27], Verdict::kMismatched);
    EXPECT_EQ(sheet.maps.verdict.row(40)[28], Verdict::kMatched);
}

TEST(Farther, WhatLiesBeyondTheRangeGoesAndTheRestIsCountedFromItsEnd)
{
    Sheet sheet(grey); // at 20 px
    sheet.maps.disparity.row(10)[5] = Sheet::px(6.996);
    sheet.maps.disparity.row(10)[6] = Sheet::px(7);
    sheet.maps.disparity.row(10)[7] = kDispMissing;
    drop_farther(sheet.maps, 7);
    EXPECT_EQ(sheet.maps.disparity.row(10)[5], kDispMissing);
    EXPECT_EQ(sheet.maps.confidence.row(10)[5], 0);
    EXPECT_EQ(sheet.maps.verdict.row(10)[5], Verdict::kMismatched);
    EXPECT_EQ(sheet.maps.disparity.row(10)[6], 0);
    EXPECT_EQ(sheet.maps.verdict.row(10)[6], Verdict::kMatched);
    EXPECT_EQ(sheet.maps.disparity.row(10)[7], kDispMissing);
    EXPECT_EQ(sheet.maps.disparity.row(40)[60], Sheet::px(13));
}

TEST(Votes, AHoleTakesWhatItsColoursNeighboursHaveAndADrawElectsNobody)
{
    Sheet sheet([](int x, int) { return x < 60 ? Rgb8{200, 40, 40} : Rgb8{40, 40, 200}; });
    for (int y = 0; y < kHeight; ++y)
        std::fill(sheet.maps.disparity.row(y) + 60, sheet.maps.disparity.row(y) + kWidth, Sheet::px(40));
    // Beside the change of colour, where half of the neighbours belong to the other side.
    sheet.mark(56, 64, 30, 38, Verdict::kMismatched);
    // Far from it, among neighbours of one colour that disagree.
    for (int y = 0; y < kHeight; ++y)
        for (int x = 80; x < kWidth; ++x)
            sheet.maps.disparity.row(y)[x] = Sheet::px((x + y) / 2 % 2 ? 40 : 45);
    sheet.maps.verdict.row(50)[100] = Verdict::kMismatched;
    take_majorities(sheet.maps, kDisparities, sheet.planes, sheet.weights, sheet.crew);
    EXPECT_EQ(sheet.maps.disparity.row(34)[58], Sheet::px(20));
    EXPECT_EQ(sheet.maps.disparity.row(34)[61], Sheet::px(40));
    EXPECT_EQ(sheet.maps.verdict.row(34)[58], Verdict::kVoted);
    EXPECT_EQ(sheet.maps.verdict.row(50)[100], Verdict::kMismatched);
}

TEST(Slants, APlaneGoesOnBeyondTheBorderAndTheFartherOneBetweenTwo)
{
    Sheet sheet(grey);
    const auto far = [](int x, int y) { return 12 + 0.08 * x + 0.05 * y; };
    const auto near = [](int x, int y) { return 45 - 0.06 * x + 0.03 * y; };
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            sheet.maps.disparity.row(y)[x] = Sheet::px(x < 70 ? far(x, y) : near(x, y));
    sheet.mark(0, 20, 0, kHeight, Verdict::kMismatched);
    sheet.mark(55, 70, 0, kHeight, Verdict::kMismatched);
    for (int y = 0; y < kHeight; ++y) {
        std::fill_n(sheet.maps.disparity.row(y), 20, Sheet::px(60));
        std::fill(sheet.maps.disparity.row(y) + 55, sheet.maps.disparity.row(y) + 70, kDispMissing);
    }
    fill_along_planes(sheet.maps, kDisparities, sheet.planes, sheet.weights, sheet.crew);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double real = x < 70 ? far(x, y) : near(x, y);
            ASSERT_NEAR(sheet.maps.disparity.row(y)[x] / 256.0, real, 0.1) << x << ", " << y;
        }
    }
}

TEST(Slants, RowsWithoutAMatchCopyTheirNeighbour)
{
    Sheet sheet(grey);
    sheet.mark(0, kWidth, 0, 5, Verdict::kMismatched);
    for (int y = 0; y < 5; ++y)
        std::fill_n(sheet.maps.disparity.row(y), kWidth, kDispMissing);
    fill_along_planes(sheet.maps, kDisparities, sheet.planes, sheet.weights, sheet.crew);
    EXPECT_EQ(sheet.maps.disparity.row(0)[60], Sheet::px(20));
}

TEST(Edges, StandBetweenColoursAndNotTowardsWhatIsOutside)
{
    const Sheet sheet([](int x, int y) { return x < 50 || y < 30 ? Rgb8{200, 40, 40} : Rgb8{40, 40, 200}; });
    std::vector<std::byte> memory(1u << 20);
    Arena arena(memory);
    RightEdges edges;
    edges.lay_out(arena, kWidth, kHeight, kDisparities);
    edges.fill_rows(sheet.planes, 0, kHeight);
    const auto sides = [&](int x, int y) { return int{edges.row(y)[x + kDisparities]}; };
    EXPECT_EQ(sides(49, 60), RightEdges::kAfter);
    EXPECT_EQ(sides(50, 60), RightEdges::kBefore);
    EXPECT_EQ(sides(80, 29), RightEdges::kBelow);
    EXPECT_EQ(sides(80, 30), RightEdges::kAbove);
    EXPECT_EQ(sides(50, 30), RightEdges::kBefore | RightEdges::kAbove);
    for (const auto& [x, y] : {std::pair{0, 0}, {0, 79}, {119, 0}, {119, 79}, {20, 20}, {-1, 40}})
        EXPECT_EQ(sides(x, y), 0) << x << ", " << y;
}

TEST(TwoSidedStep, PaysAnEighthExactlyWhereEitherPictureHasAnEdge)
{
    constexpr int kAxis = 40, kFirst = 3;
    Scene scene{};
    scene.kernels = &kScalarKernels;
    scene.axis = kAxis;
    scene.disparities = kAxis - kFirst;
    std::mt19937 random(5);
    for (int round = 0; round < 200; ++round) {
        std::vector<std::uint16_t> costs(kAxis), behind(kAxis), ahead(kAxis), scratch(kAxis);
        std::vector<std::uint8_t> sides(kAxis);
        std::uint16_t least = kNoCandidate;
        for (int r = 0; r < kAxis; ++r) {
            const auto i = static_cast<std::size_t>(r);
            costs[i] = static_cast<std::uint16_t>(random() % (kWorstCost + 1));
            behind[i] = r < kFirst ? kNoCandidate : static_cast<std::uint16_t>(random() % kWorstCost);
            sides[i] = static_cast<std::uint8_t>(round % 4 == 0 ? 0 : random() % 16);
            least = std::min(least, behind[i]);
        }
        const bool left_edge = round % 3 == 0;
        const TwoSidedStep step{scene, kBestSteps, scratch.data()};
        const int got =
            step(ahead.data(), costs.data(), behind.data(), least, left_edge, sides.data(), RightEdges::kAbove);
        int expected_least = kNoCandidate;
        for (int r = kFirst; r < kAxis; ++r) {
            const auto at = [&](int position) {
                return position < kFirst || position >= kAxis ? 1 << 20
                                                              : int{behind[static_cast<std::size_t>(position)]};
            };
            const auto i = static_cast<std::size_t>(r);
            const int part = left_edge || (sides[i] & RightEdges::kAbove) != 0 ? 8 : 1;
            const int expected = costs[i] - least +
                                 std::min({at(r), std::min(at(r - 1), at(r + 1)) + kBestSteps.within.small / part,
                                           least + kBestSteps.within.large / part});
            ASSERT_EQ(ahead[i], expected) << "round " << round << ", position " << r;
            expected_least = std::min(expected_least, expected);
        }
        ASSERT_EQ(got, expected_least);
    }
}

} // namespace
} // namespace dicot::matching
