// Two views of a drawn scene whose shift, offset and roll are known.
#include "lent_arena.h"
#include "spotted_wall.h"

#include "dicot/aiming/views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace dicot::aiming {
namespace {

constexpr int kWidth = 640, kHeight = 480;

struct Picture
{
    std::vector<std::uint8_t> pixels;

    template <typename Level>
    explicit Picture(const Level& level)
    {
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                pixels.push_back(static_cast<std::uint8_t>(
                    std::clamp(level(x - (kWidth - 1) / 2.0, y - (kHeight - 1) / 2.0), 0.0, 255.0)));
    }
    ImageView<const std::uint8_t> view() const { return {pixels.data(), kWidth, kHeight}; }
};

/// How the right camera differs from the left one.
struct Pose
{
    double far_px = 20, near_px = 60; ///< shifts of the wall, and of a board before it
    double rise_px = 0;
    double clockwise_deg = 0;
};

/// The drawn scene, wall and board moved by so many pixels to the left.
double seen(const test::SpottedWall& wall, const test::SpottedWall& board, double x, double y, double far_px,
            double near_px)
{
    const bool on_board = std::fabs(x + near_px) < 130 && std::fabs(y) < 100;
    return on_board ? board.at(x + near_px, y) : wall.at(x + far_px, y);
}

class TwoViews : public testing::Test
{
protected:
    static constexpr unsigned kSeed = 20;

    Picture left() const
    {
        return Picture([&](double x, double y) { return seen(wall_, board_, x, y, 0, 0); });
    }
    Picture right(const Pose& pose) const
    {
        const double turn = pose.clockwise_deg / 57.29577951308232;
        return Picture([&](double x, double y) {
            // A camera turned clockwise shows the scene turned the other way.
            const double down = y - pose.rise_px;
            const double u = x * std::cos(turn) - down * std::sin(turn);
            const double v = x * std::sin(turn) + down * std::cos(turn);
            return 10 + 0.9 * seen(wall_, board_, u, v, pose.far_px, pose.near_px);
        });
    }
    static Result<Views> compare(ImageView<const std::uint8_t> left, ImageView<const std::uint8_t> right)
    {
        test::LentArena scratch(view_scratch_bytes(left.width, left.height));
        Arena& arena = scratch.arena();
        Result<Views> views = compare_views(left, right, arena);
        EXPECT_EQ(arena.used(), 0u);
        EXPECT_FALSE(arena.overrun());
        return views;
    }
    Views views_of(const Pose& pose) const { return compare(left().view(), right(pose).view()).value(); }

private:
    test::SpottedWall wall_{kSeed}, board_{kSeed + 1};
};

TEST_F(TwoViews, ParallelCamerasShiftByWhatIsNearAndFar)
{
    const Views views = views_of({});
    ASSERT_TRUE(views.known()) << views.matches << " of " << views.patches;
    EXPECT_EQ(views.order, Order::kAsNamed);
    EXPECT_NEAR(views.shift_low_px, 20, 0.5);
    EXPECT_NEAR(views.shift_high_px, 60, 0.5);
    EXPECT_NEAR(views.vertical_px, 0, 0.2);
    EXPECT_NEAR(views.roll_deg, 0, 0.05);
    EXPECT_NEAR(views.overlap_percent, 100 - 100 * views.shift_px / kWidth, 1);
}

TEST_F(TwoViews, RollAndOffsetAreMeasured)
{
    for (const double degrees : {-3.0, -1.2, 0.5, 2.5, 6.0})
        for (const double rise_px : {-22.0, 9.0}) {
            const Views views = views_of({.rise_px = rise_px, .clockwise_deg = degrees});
            ASSERT_TRUE(views.known()) << degrees << " degrees, " << rise_px << " px";
            EXPECT_NEAR(views.roll_deg, degrees, 0.15);
            // What is shifted by 20 to 60 px is raised by that times the sine of the turn, too.
            EXPECT_NEAR(views.vertical_px, rise_px + 30 * std::sin(degrees / 57.3), 2.0) << degrees << " degrees";
            EXPECT_EQ(views.order, Order::kAsNamed);
        }
}

TEST_F(TwoViews, SwappedPicturesAreSeenToBe)
{
    for (const double degrees : {-1.0, 0.0, 2.0}) {
        const Views views = compare(right({.clockwise_deg = degrees}).view(), left().view()).value();
        EXPECT_EQ(views.order, Order::kSwapped) << degrees;
        EXPECT_NEAR(views.roll_deg, -degrees, 0.15);
    }
}

TEST_F(TwoViews, CamerasTurnedTowardsEachOtherLeaveTheOrderOpen)
{
    const Pose toe_in{.far_px = -40, .near_px = 15};
    EXPECT_EQ(views_of(toe_in).order, Order::kNotKnown);
    EXPECT_EQ(compare(right(toe_in).view(), left().view()).value().order, Order::kNotKnown);
}

TEST_F(TwoViews, OnePictureTwiceHasNoOrder)
{
    const Picture picture = left();
    const Views views = compare(picture.view(), picture.view()).value();
    EXPECT_TRUE(views.known());
    EXPECT_EQ(views.order, Order::kNotKnown);
    EXPECT_NEAR(views.shift_px, 0, 0.01);
    EXPECT_EQ(views.overlap_percent, 100);
}

TEST_F(TwoViews, DifferentScenesAndEmptyOnesAreNotKnown)
{
    const test::SpottedWall other(kSeed + 2);
    const Picture elsewhere([&](double x, double y) { return other.at(x, y); });
    const Picture grey([](double, double) { return 90.0; });
    std::mt19937 random{kSeed};
    const Picture noise([&](double, double) { return static_cast<double>(random() % 256); });
    std::mt19937 again{kSeed + 1};
    const Picture other_noise([&](double, double) { return static_cast<double>(again() % 256); });
    for (const Views& views :
         {compare(left().view(), elsewhere.view()).value(), compare(left().view(), grey.view()).value(),
          compare(grey.view(), grey.view()).value(), compare(noise.view(), other_noise.view()).value()}) {
        EXPECT_FALSE(views.known()) << views.matches << " of " << views.patches;
        EXPECT_EQ(views.order, Order::kNotKnown);
        EXPECT_EQ(views.overlap_percent, 0);
    }
}

TEST_F(TwoViews, RefusalsNameTheSizes)
{
    const Picture picture = left();
    const Result<Views> uneven = compare(picture.view(), {picture.pixels.data(), kWidth, kHeight - 2});
    ASSERT_FALSE(uneven.ok());
    EXPECT_EQ(uneven.status().fault(), Fault::kBadData);
    EXPECT_NE(std::string{uneven.status().message()}.find("640 x 478"), std::string::npos) << uneven.status().message();

    const ImageView<const std::uint8_t> small{picture.pixels.data(), kMinViewSide, kMinViewSide - 1, kWidth};
    EXPECT_EQ(compare(small, small).status().fault(), Fault::kBadData);

    Arena none;
    EXPECT_EQ(compare_views(picture.view(), picture.view(), none).status().fault(), Fault::kConfig);
}

TEST_F(TwoViews, TheSmallestAndOddSizesAreHeld)
{
    const Picture one = left(), other = right({});
    struct Size
    {
        int width, height;
    };
    for (const Size& size : {Size{96, 96}, Size{97, 101}, Size{199, 96}, Size{639, 479}}) {
        const auto cut = [&](const Picture& picture) {
            return ImageView<const std::uint8_t>{picture.pixels.data(), size.width, size.height, kWidth};
        };
        const Result<Views> views = compare(cut(one), cut(other));
        ASSERT_TRUE(views.ok()) << views.status().message();
        EXPECT_NE(views.value().order, Order::kSwapped) << size.width << " x " << size.height;
    }
}

TEST_F(TwoViews, StripsAreHeld)
{
    std::mt19937 random{kSeed};
    std::vector<std::uint8_t> noise(std::size_t{kMinViewSide} * kMaxViewSide);
    for (std::uint8_t& pixel : noise)
        pixel = static_cast<std::uint8_t>(random());
    for (const auto& strip : {ImageView<const std::uint8_t>{noise.data(), kMinViewSide, kMaxViewSide},
                              ImageView<const std::uint8_t>{noise.data(), kMaxViewSide, kMinViewSide}}) {
        const Result<Views> views = compare(strip, strip);
        ASSERT_TRUE(views.ok()) << views.status().message();
        EXPECT_NE(views.value().order, Order::kSwapped);
    }
}

} // namespace
} // namespace dicot::aiming
