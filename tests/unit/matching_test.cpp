#include "matched.h"

#include "dicot/matching/matcher.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace dicot {
namespace {

struct Pair
{
    int width, height;
    std::vector<Rgb8> left, right;
    ImageView<const Rgb8> left_view() const { return {left.data(), width, height}; }
    ImageView<const Rgb8> right_view() const { return {right.data(), width, height}; }
};

/// A textured plane at one disparity, with a nearer textured square in the middle.
Pair scene(int width, int height, int far_px, int near_px, unsigned seed)
{
    std::mt19937 random(seed);
    const auto texture = [&](int w, int h) {
        std::vector<Rgb8> pixels(static_cast<std::size_t>(w * h));
        for (Rgb8& p : pixels)
            p = {static_cast<std::uint8_t>(random() % 256), static_cast<std::uint8_t>(random() % 256),
                 static_cast<std::uint8_t>(random() % 256)};
        return pixels;
    };
    const std::vector<Rgb8> back = texture(width + 64, height);
    const std::vector<Rgb8> front = texture(width, height);
    Pair pair{width, height, {}, {}};
    const auto in_square = [&](int x, int y) {
        return x > width / 2 && x < width * 3 / 4 && y > height / 4 && y < height * 3 / 4;
    };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto at = [&](const std::vector<Rgb8>& from, int column, int stride) {
                return from[static_cast<std::size_t>(y * stride + column)];
            };
            pair.left.push_back(in_square(x, y) ? at(front, x, width) : at(back, x, width + 64));
            pair.right.push_back(in_square(x + near_px, y) ? at(front, x + near_px, width)
                                                           : at(back, x + far_px, width + 64));
        }
    }
    return pair;
}

MatchOptions small_options()
{
    MatchOptions options;
    options.disparities = 24;
    options.window = 9;
    return options;
}

bool same_bytes(const DisparityMap& a, const DisparityMap& b)
{
    const auto pixels = static_cast<std::size_t>(a.relative.width * a.relative.height);
    return a.relative.same_size(b.relative) && std::memcmp(a.relative.data, b.relative.data, pixels * 2) == 0 &&
           std::memcmp(a.confidence.data, b.confidence.data, pixels) == 0;
}

TEST(Matcher, FindsThePlaneAndTheSquareInFrontOfIt)
{
    const Pair pair = scene(120, 60, 5, 15, 7);
    const Matched matched(pair.left_view(), pair.right_view(), small_options());
    EXPECT_NEAR(matched.map().relative.at(30, 30) / 256.0, 5.0, 0.3);
    EXPECT_NEAR(matched.map().relative.at(75, 30) / 256.0, 15.0, 0.3);
}

TEST(Matcher, FastFindsThemToo)
{
    const Pair pair = scene(120, 60, 5, 15, 7);
    MatchOptions options = small_options();
    options.method = MatchMethod::kFast;
    const Matched matched(pair.left_view(), pair.right_view(), options);
    EXPECT_NEAR(matched.map().relative.at(30, 30) / 256.0, 5.0, 0.3);
    EXPECT_NEAR(matched.map().relative.at(75, 30) / 256.0, 15.0, 0.3);
    EXPECT_EQ(matched.map().relative.at(56, 30), kDispMissing);
}

TEST(Matcher, FastMatchesWithTheSmallestWindowsAndEveryWindowBetweenPairs)
{
    // Rows and slots pair differently with 1, 2, 3, 4 rows on each side, and a picture may be lower than its window.
    for (const int window : {3, 5, 7, 9, 35}) {
        for (const int height : {8, 41}) {
            const Pair pair = scene(107, height, 4, 4, 5);
            MatchOptions options = small_options();
            options.method = MatchMethod::kFast;
            options.window = window;
            const Matched law(pair.left_view(), pair.right_view(), options, &kScalarKernels, 1);
            options.band_rows = 3;
            const Matched other(pair.left_view(), pair.right_view(), options, nullptr, 2);
            EXPECT_TRUE(same_bytes(law.map(), other.map())) << window << ", " << height;
            EXPECT_NEAR(law.map().relative.at(40, height / 2) / 256.0, 4.0, 0.3) << window << ", " << height;
        }
    }
}

TEST(Matcher, FastTakesNoMoreMemoryThanStandardAndBestAtMostATenthMore)
{
    struct Size
    {
        int width, height, disparities;
    };
    for (const Size size : {Size{640, 480, 64}, Size{1280, 720, 121}}) {
        const auto need = [&](MatchMethod method) {
            MatchOptions options;
            options.disparities = size.disparities;
            options.method = method;
            Arena measure;
            EXPECT_TRUE(Matcher::make(size.width, size.height, options, kScalarKernels, 2, measure).ok());
            return measure.peak();
        };
        EXPECT_LE(need(MatchMethod::kFast), need(MatchMethod::kStandard)) << size.width;
        EXPECT_LE(need(MatchMethod::kBest), need(MatchMethod::kStandard) / 10 * 11) << size.width;
    }
}

TEST(Matcher, BestTakesTheSameMemoryWhereverTheRangeBegins)
{
    const auto need = [](int min_disparity) {
        MatchOptions options;
        options.method = MatchMethod::kBest;
        options.min_disparity = min_disparity;
        Arena measure;
        EXPECT_TRUE(Matcher::make(640, 480, options, kScalarKernels, 4, measure).ok());
        return measure.peak();
    };
    for (const int min_disparity : {-20, 5, 60})
        EXPECT_EQ(need(min_disparity), need(0)) << min_disparity;
}

TEST(Matcher, BestDoesNotTakeBackgroundForWhatItResemblesWithinTheRange)
{
    // A wall that nearly repeats every 16 px stands at 5 px, before it a square at 15 px; searched from 7 to 30 px,
    // where the wall's likeness is at 21 px.
    Pair pair = scene(120, 60, 5, 15, 7);
    for (std::vector<Rgb8>* picture : {&pair.left, &pair.right}) {
        const int shift = picture == &pair.left ? 0 : 5;
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 120; ++x) {
                const int in_left = picture == &pair.left ? x : x + 15;
                if (in_left > 60 && in_left < 90 && y > 15 && y < 45)
                    continue;
                const auto level = static_cast<std::uint8_t>((x + shift) % 16 * 37 % 97 * 2 + (x + shift) / 16 + y);
                (*picture)[static_cast<std::size_t>(y * 120 + x)] = {level, level, level};
            }
    }
    MatchOptions options = small_options();
    options.method = MatchMethod::kBest;
    options.min_disparity = 7;
    const Matched matched(pair.left_view(), pair.right_view(), options);
    EXPECT_EQ(matched.map().min_disparity, 7);
    EXPECT_EQ(matched.map().disparities, options.disparities);
    EXPECT_NEAR(matched.map().relative.at(75, 30) / 256.0, 15.0 - 7, 0.3);
    for (int y = 0; y < 60; ++y)
        for (int x = 30; x < 55; ++x)
            ASSERT_EQ(matched.map().relative.at(x, y), kDispMissing) << x << ", " << y;
    options.dense = true;
    const Matched dense(pair.left_view(), pair.right_view(), options);
    EXPECT_NEAR(dense.map().relative.at(75, 30) / 256.0, 15.0 - 7, 0.3);
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 120; ++x)
            ASSERT_LE(dense.map().relative.at(x, y), (options.disparities - 1) << 8) << x << ", " << y;
}

TEST(Matcher, StandardLeavesHiddenPixelsWithoutAValueAndDenseFillsThemFromBehind)
{
    const Pair pair = scene(120, 60, 5, 15, 7);
    MatchOptions options = small_options();
    // Just left of the square, ten pixels of the plane are hidden from the right camera.
    const Matched sparse(pair.left_view(), pair.right_view(), options);
    EXPECT_EQ(sparse.map().relative.at(56, 30), kDispMissing);
    EXPECT_EQ(sparse.map().confidence.at(56, 30), 0);
    options.dense = true;
    const Matched dense(pair.left_view(), pair.right_view(), options);
    EXPECT_NEAR(dense.map().relative.at(56, 30) / 256.0, 5.0, 0.5);
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 120; ++x)
            ASSERT_NE(dense.map().relative.at(x, y), kDispMissing) << x << ", " << y;
}

TEST(Matcher, ARangeOfOneToThreeDisparitiesIsMatched)
{
    const Pair pair = scene(120, 60, 5, 5, 7);
    for (const MatchMethod method :
         {MatchMethod::kPaper, MatchMethod::kFast, MatchMethod::kStandard, MatchMethod::kBest})
        for (const int disparities : {1, 2, 3}) {
            MatchOptions options = small_options();
            options.method = method;
            options.disparities = disparities;
            options.min_disparity = 5 - disparities / 2;
            const Matched matched(pair.left_view(), pair.right_view(), options);
            int found = 0;
            for (int y = 0; y < 60; ++y)
                for (int x = 20; x < 120; ++x)
                    found += std::abs(matched.map().relative.at(x, y) - (disparities / 2) * 256) < 64;
            EXPECT_GE(found, 60 * 100 * 95 / 100) << static_cast<int>(method) << ", " << disparities;
        }
}

TEST(Matcher, MinDisparityMovesTheSearchRangeInBothDirections)
{
    for (const int shift : {-7, 3}) {
        Pair pair = scene(120, 40, 5, 5, 11);
        // The right picture moved by `shift`: all disparities grow by it.
        Pair moved = pair;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 120; ++x)
                moved.right[static_cast<std::size_t>(y * 120 + x)] =
                    pair.right[static_cast<std::size_t>(y * 120 + std::clamp(x + shift, 0, 119))];
        MatchOptions options = small_options();
        options.disparities = 16;
        options.min_disparity = shift;
        const Matched matched(moved.left_view(), moved.right_view(), options);
        EXPECT_EQ(matched.map().min_disparity, shift);
        EXPECT_NEAR(matched.map().relative.at(60, 20) / 256.0, 5.0, 0.3) << "shift " << shift;
    }
}

struct Variant
{
    const char* name;
    int workers;
    int band_rows;
    bool scalar;
};

class SameBytes : public ::testing::TestWithParam<Variant>
{
};

TEST_P(SameBytes, ForAnyThreadsBandsAndKernels)
{
    const Variant variant = GetParam();
    for (const MatchMethod method :
         {MatchMethod::kPaper, MatchMethod::kFast, MatchMethod::kStandard, MatchMethod::kBest}) {
        for (const bool dense : {false, true}) {
            // Odd sizes: strips, groups and vectors all end in the middle.
            const Pair pair = scene(107, 43, 4, 13, 23);
            MatchOptions options = small_options();
            options.disparities = 21;
            options.method = method;
            options.dense = dense;
            const Matched law(pair.left_view(), pair.right_view(), options, &kScalarKernels, 1);
            options.band_rows = variant.band_rows;
            const Matched other(pair.left_view(), pair.right_view(), options,
                                variant.scalar ? &kScalarKernels : nullptr, variant.workers);
            EXPECT_TRUE(same_bytes(law.map(), other.map()));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Variants, SameBytes,
                         ::testing::Values(Variant{"BestKernels", 1, 0, false}, Variant{"TwoWorkers", 2, 0, true},
                                           Variant{"ThreeWorkersBandsOfOneRow", 3, 1, false},
                                           Variant{"TwoWorkersBandsOfSeven", 2, 7, false},
                                           Variant{"MoreWorkersThanRows", 50, 0, false}),
                         [](const auto& tested) { return tested.param.name; });

TEST(Matcher, ASecondPairIsNotTouchedByTheFirstNorByWhatTheMemoryHeld)
{
    // High, and of few disparities: what lives after the rows is larger than all of their tables.
    constexpr int kWidth = 61, kHeight = 120;
    const Pair first = scene(kWidth, kHeight, 1, 4, 1);
    const Pair second = scene(kWidth, kHeight, 3, 6, 2);
    for (const MatchMethod method :
         {MatchMethod::kPaper, MatchMethod::kFast, MatchMethod::kStandard, MatchMethod::kBest}) {
        for (const bool dense : {false, true}) {
            MatchOptions options = small_options();
            options.method = method;
            options.dense = dense;
            options.disparities = 8;
            Arena measure;
            ASSERT_TRUE(Matcher::make(kWidth, kHeight, options, kScalarKernels, 2, measure).ok());
            std::vector<std::byte> block(measure.peak() + Arena::kAlignment, std::byte{0xA5});
            void* start = block.data();
            std::size_t space = block.size();
            ASSERT_NE(std::align(Arena::kAlignment, measure.peak(), start, space), nullptr);
            Arena arena({static_cast<std::byte*>(start), measure.peak()});
            Result<Matcher> matcher = Matcher::make(kWidth, kHeight, options, kScalarKernels, 2, arena);
            ASSERT_TRUE(matcher.ok()) << matcher.status().message();
            Alone crew;
            for (const Pair* pair : {&first, &second, &first}) {
                const MatchOutcome outcome = matcher.value().match(pair->left_view(), pair->right_view(), crew);
                const Matched fresh(pair->left_view(), pair->right_view(), options, &kScalarKernels, 1);
                EXPECT_TRUE(same_bytes(outcome.map, fresh.map())) << static_cast<int>(method) << ", " << dense;
            }
        }
    }
}

TEST(Matcher, AnArenaThatIsTooSmallIsRefusedAndNotWritten)
{
    const MatchOptions options = small_options();
    alignas(Arena::kAlignment) static std::array<std::byte, 4096> block;
    block.fill(std::byte{0xA5});
    Arena arena(block);
    const Result<Matcher> matcher = Matcher::make(64, 32, options, kScalarKernels, 1, arena);
    ASSERT_FALSE(matcher.ok());
    EXPECT_EQ(matcher.status().fault(), Fault::kConfig);
    for (const std::byte b : block)
        ASSERT_EQ(b, std::byte{0xA5});
}

TEST(Matcher, FlatPicturesGiveNoValueUnlessTheyMustBeDense)
{
    Pair pair{40, 20, std::vector<Rgb8>(800, Rgb8{90, 120, 60}), std::vector<Rgb8>(800, Rgb8{90, 120, 60})};
    for (const MatchMethod method : {MatchMethod::kFast, MatchMethod::kStandard, MatchMethod::kBest}) {
        MatchOptions options = small_options();
        options.method = method;
        const Matched sparse(pair.left_view(), pair.right_view(), options);
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 40; ++x)
                ASSERT_EQ(sparse.map().relative.at(x, y), kDispMissing) << x << ", " << y;
        options.dense = true;
        const Matched dense(pair.left_view(), pair.right_view(), options);
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 40; ++x)
                ASSERT_NE(dense.map().relative.at(x, y), kDispMissing) << x << ", " << y;
    }
}

TEST(Matcher, RefusesWhatItCannotMatchAndNamesTheRange)
{
    const auto refused = [](int width, int height, auto change) {
        MatchOptions options;
        change(options);
        return Matcher::check(width, height, options);
    };
    EXPECT_EQ(refused(1, 1, [](MatchOptions&) {}).fault(), Fault::kBadData);
    EXPECT_EQ(refused(640, 480, [](MatchOptions& o) { o.disparities = 0; }).fault(), Fault::kUsage);
    EXPECT_EQ(refused(640, 480, [](MatchOptions& o) { o.disparities = kMaxDisparities + 1; }).fault(), Fault::kUsage);
    EXPECT_EQ(refused(32, 480, [](MatchOptions& o) { o.disparities = 33; }).fault(), Fault::kUsage);
    EXPECT_EQ(refused(640, 480, [](MatchOptions& o) { o.min_disparity = 640; }).fault(), Fault::kUsage);
    EXPECT_EQ(refused(640, 480, [](MatchOptions& o) { o.window = 34; }).fault(), Fault::kUsage);
    EXPECT_EQ(refused(640, 480, [](MatchOptions& o) { o.window = 37; }).fault(), Fault::kUsage);
    EXPECT_EQ(refused(640, 480, [](MatchOptions& o) { o.gamma_color = std::nan(""); }).fault(), Fault::kUsage);
    EXPECT_EQ(refused(640, 480, [](MatchOptions& o) { o.gamma_space = -1; }).fault(), Fault::kUsage);
    EXPECT_TRUE(refused(640, 480, [](MatchOptions&) {}).ok());
}

} // namespace
} // namespace dicot
