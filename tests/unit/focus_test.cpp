// The focus figure on edges whose width is known because they are drawn.
#include "dicot/aiming/focus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace dicot::aiming {
namespace {

struct Picture
{
    int width = 240, height = 180;
    std::vector<std::uint8_t> pixels;

    template <typename Level>
    explicit Picture(const Level& level)
    {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                pixels.push_back(static_cast<std::uint8_t>(std::clamp(level(x, y), 0.0, 255.0)));
    }
    ImageView<const std::uint8_t> view() const { return {pixels.data(), width, height}; }
};

/// Bars of 20 px, dark and bright in turn, whose edges rise evenly over `edge_px` pixels.
double bars(int position, int edge_px, double dark, double bright)
{
    const int phase = position % 40;
    const double up = std::clamp(static_cast<double>(phase) / edge_px, 0.0, 1.0);
    const double down = std::clamp(static_cast<double>(phase - 20) / edge_px, 0.0, 1.0);
    return dark + (bright - dark) * (up - down);
}

class EdgesOf : public testing::TestWithParam<int>
{
};

TEST_P(EdgesOf, KnownWidthHaveTheReciprocalFigure)
{
    const int edge_px = GetParam();
    const Picture picture([&](int x, int) { return bars(x, edge_px, 20, 220); });
    EXPECT_EQ(focus_of(picture.view()).whole, 100 / edge_px);
}

INSTANTIATE_TEST_SUITE_P(Pixels, EdgesOf, testing::Values(1, 2, 4, 5, 8, 10));

TEST(Focus, IsTheSameInAnyLightAndEitherDirection)
{
    const Picture across([](int x, int) { return bars(x, 4, 0, 240); });
    const Picture darker([](int x, int) { return bars(x, 4, 10, 70); });
    const Picture down([](int, int y) { return bars(y, 4, 0, 240); });
    EXPECT_EQ(focus_of(across.view()).whole, 25);
    EXPECT_EQ(focus_of(darker.view()).whole, 25);
    EXPECT_EQ(focus_of(down.view()).whole, 25);
}

TEST(Focus, TellsTheRegionThatIsBlurred)
{
    const Picture picture([](int x, int) { return bars(x, x < 80 ? 8 : 2, 20, 220); });
    const Focus focus = focus_of(picture.view());
    for (const std::size_t row : {0u, 3u, 6u}) {
        EXPECT_NEAR(focus.region[row], 12, 1);
        EXPECT_EQ(focus.region[row + 1], 50);
        EXPECT_EQ(focus.region[row + 2], 50);
    }
}

TEST(Focus, NoiseIsNoEdge)
{
    constexpr unsigned kSeed = 7;
    std::mt19937 random{kSeed};
    std::normal_distribution<double> noise(0, 3);
    const Picture dark([&](int, int) { return 12 + noise(random); });
    EXPECT_FALSE(focus_of(dark.view()).known());
    const Picture soft([&](int x, int) { return bars(x, 8, 20, 220) + noise(random); });
    EXPECT_NEAR(focus_of(soft.view()).whole, 12, 5) << "seed " << kSeed;
}

TEST(Focus, IsNotKnownWhereThereIsNothingToSee)
{
    const Picture flat([](int, int) { return 128.0; });
    EXPECT_EQ(focus_of(flat.view()), Focus{});
    const Picture bars_of_two([](int x, int) { return bars(x, 1, 0, 255); });
    EXPECT_EQ(focus_of({bars_of_two.pixels.data(), 31, 100, 240}), Focus{});
}

TEST(Focus, StrideAndRimAreHeld)
{
    const Picture picture([](int x, int y) { return bars(x + y / 3, 2, 0, 255); });
    const int width = 101, height = 67;
    std::vector<std::uint8_t> cut;
    for (int y = 0; y < height; ++y)
        cut.insert(cut.end(), picture.pixels.begin() + y * picture.width,
                   picture.pixels.begin() + y * picture.width + width);
    EXPECT_EQ(focus_of({picture.pixels.data(), width, height, picture.width}), focus_of({cut.data(), width, height}));
}

} // namespace
} // namespace dicot::aiming
