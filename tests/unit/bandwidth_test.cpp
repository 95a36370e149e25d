#include "dicot/camera/bandwidth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <string_view>
#include <vector>

namespace dicot {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t k30 = 333333;
constexpr std::uint32_t k15 = 666666;
constexpr std::uint32_t k10 = 1000000;
constexpr std::uint32_t k5 = 2000000;

CameraMode mode(PixelFormat format, int width, int height, std::uint32_t interval)
{
    return {format, width, height, interval};
}

/// Alternate settings as cheap high-speed webcams have them: from 192 to 3 x 1020 bytes a microframe.
const std::vector<AlternateSetting> kWebcam{
    {1, 192, 1},  {2, 384, 1},  {3, 512, 1},  {4, 640, 1},   {5, 800, 1},   {6, 944, 1},
    {7, 1280, 1}, {8, 1600, 1}, {9, 1984, 1}, {10, 2688, 1}, {11, 3060, 1},
};

const std::vector<StreamOffer> kVgaOffers{
    {mode(PixelFormat::kYuyv, 640, 480, k30), 0},  {mode(PixelFormat::kYuyv, 640, 480, k15), 0},
    {mode(PixelFormat::kYuyv, 640, 480, k10), 0},  {mode(PixelFormat::kYuyv, 640, 480, k5), 0},
    {mode(PixelFormat::kMjpeg, 640, 480, k30), 0}, {mode(PixelFormat::kMjpeg, 640, 480, k15), 0},
};

BusUser webcam(int bus, const std::vector<StreamOffer>& offers = kVgaOffers)
{
    return {.bus = bus, .settings = kWebcam, .offers = offers};
}

TEST(Bandwidth, EstimatesAreBytesOverTimeAndAHeader)
{
    // 614400 bytes in 33.3333 ms are 2304.002 in 125 us.
    EXPECT_EQ(estimated_payload(mode(PixelFormat::kYuyv, 640, 480, k30), UsbSpeed::kHigh), 2305U + 12);
    EXPECT_EQ(estimated_payload(mode(PixelFormat::kYuyv, 640, 480, k10), UsbSpeed::kHigh), 768U + 12);
    EXPECT_EQ(estimated_payload(mode(PixelFormat::kMjpeg, 640, 480, k10), UsbSpeed::kHigh), 192U + 12);
    EXPECT_EQ(estimated_payload(mode(PixelFormat::kGrey, 160, 120, k10), UsbSpeed::kFull), 192U + 12);
}

TEST(Bandwidth, BusTimeIsTheUsbSpecificationsArithmetic)
{
    EXPECT_EQ(bus_time(3072, UsbSpeed::kHigh, false), 3584U + 3 * 38);
    EXPECT_EQ(bus_time(1025, UsbSpeed::kHigh, false), 1196U + 2 * 38);
    EXPECT_EQ(bus_time(512, UsbSpeed::kHigh, true), 598U + 55);
    EXPECT_EQ(bus_time(1023, UsbSpeed::kFull, false), 1194U + 9);
    EXPECT_EQ(bus_time(0, UsbSpeed::kHigh, false), 0U);
}

TEST(Bandwidth, TwoWebcamsOnOneHighSpeedBusGoDownToARateThatFits)
{
    const BandwidthPlan plan = plan_bandwidth(webcam(1), webcam(1), 0);
    ASSERT_EQ(plan.together, Together::kAtOnce);
    // At 30/s each needs 2688 bytes: 2 x (3136 + 114) = 6500 > 6000. At 15/s 1165: 1280.
    EXPECT_EQ(plan.left.mode, mode(PixelFormat::kYuyv, 640, 480, k15));
    EXPECT_EQ(plan.right.mode, plan.left.mode);
    EXPECT_EQ(plan.left.alternate, 7);
    EXPECT_EQ(plan.left.reserved_bytes_per_s, 1280U * 8000);
    EXPECT_STREQ(
        plan.why,
        "YUYV 640x480 at 15.0/s, both at once: takes 52 % of what may be reserved on bus 1, where YUYV 640x480 "
        "at 30.0/s would take 108 %");
}

TEST(Bandwidth, OnTwoBusesThePreferredModeFits)
{
    const BandwidthPlan plan = plan_bandwidth(webcam(1), webcam(3), 0);
    ASSERT_EQ(plan.together, Together::kAtOnce);
    EXPECT_EQ(plan.left.mode, kVgaOffers[0].mode);
    EXPECT_EQ(plan.left.alternate, 10);
    EXPECT_STREQ(plan.why,
                 "YUYV 640x480 at 30.0/s, both at once: takes 54 % of what may be reserved on buses of their own");
}

TEST(Bandwidth, ADeviceThatAsksForEverythingIsBelievedByTheKernelsDriver)
{
    // MJPEG that asks for 3060 bytes a microframe at every rate: the well-known "no space left on device".
    const std::vector<StreamOffer> greedy{{mode(PixelFormat::kMjpeg, 1280, 720, k30), 3060},
                                          {mode(PixelFormat::kMjpeg, 1280, 720, k15), 3060}};
    const BandwidthPlan kernel = plan_bandwidth(webcam(1, greedy), webcam(1, greedy), 0);
    EXPECT_EQ(kernel.together, Together::kOneAfterTheOther);
    EXPECT_EQ(kernel.left.alternate, 11);
    EXPECT_THAT(kernel.why, HasSubstr("one camera after the other: takes 61 %"));

    BusUser free = webcam(1, greedy);
    free.chooses_alternate = true;
    const BandwidthPlan own = plan_bandwidth(free, free, 0);
    EXPECT_EQ(own.together, Together::kAtOnce);
    EXPECT_EQ(own.left.mode, greedy[0].mode)
        << "460800 bytes a frame are 1728 + 12; 2688 twice does not fit, 1984 does";
    EXPECT_EQ(own.left.alternate, 9);
}

TEST(Bandwidth, ASmallerSettingStillCarriesTheEstimatedStream)
{
    const std::vector<StreamOffer> greedy{{mode(PixelFormat::kYuyv, 640, 480, k10), 3060}};
    BusUser free = webcam(1, greedy);
    free.chooses_alternate = true;
    std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
    for (int refused = 0; refused < 20; ++refused) {
        const BandwidthPlan plan = plan_bandwidth(free, free, refused);
        if (plan.together != Together::kAtOnce)
            break;
        EXPECT_GE(plan.left.reserved_bytes_per_s, 780U * 8000) << refused;
        EXPECT_LT(plan.left.bus_time, last);
        last = plan.left.bus_time;
    }
    EXPECT_EQ(last, bus_time(800, UsbSpeed::kHigh, false)) << "800 is the smallest setting of at least 780";
}

TEST(Bandwidth, RefusalsStepDownToOneAfterTheOtherAndThenToNothing)
{
    std::vector<std::pair<Together, PixelFormat>> seen;
    for (int refused = 0; refused < 30; ++refused) {
        const BandwidthPlan plan = plan_bandwidth(webcam(1), webcam(1), refused);
        if (plan.together == Together::kNotAtAll) {
            EXPECT_THAT(plan.why, HasSubstr("refused whatever fits"));
            break;
        }
        seen.emplace_back(plan.together, plan.left.mode.format);
        EXPECT_EQ(std::string_view{plan.why}.find("that it is full") != std::string_view::npos, refused > 0)
            << plan.why;
    }
    using enum Together;
    using enum PixelFormat;
    // YUYV at 15, 10, 5 (1280, 800, 512); MJPEG at 15 alone asks for less than that (MJPEG at 30: 640 > 512).
    EXPECT_THAT(seen, testing::ElementsAre(std::pair{kAtOnce, kYuyv}, std::pair{kAtOnce, kYuyv},
                                           std::pair{kAtOnce, kYuyv}, std::pair{kAtOnce, kMjpeg},
                                           std::pair{kOneAfterTheOther, kYuyv}, std::pair{kOneAfterTheOther, kMjpeg}));
}

TEST(Bandwidth, FullSpeedCarriesOneSmallCameraAtATime)
{
    const std::vector<AlternateSetting> settings{{1, 1023, 1}};
    const std::vector<StreamOffer> offers{{mode(PixelFormat::kYuyv, 160, 120, k15), 0}};
    const BusUser user{.bus = 2, .speed = UsbSpeed::kFull, .settings = settings, .offers = offers};
    const BandwidthPlan plan = plan_bandwidth(user, user, 0);
    EXPECT_EQ(plan.together, Together::kOneAfterTheOther);
    EXPECT_EQ(plan.left.reserved_bytes_per_s, 1023U * 1000);

    const std::vector<StreamOffer> large{{mode(PixelFormat::kYuyv, 640, 480, k15), 0}};
    const BusUser hungry{.bus = 2, .speed = UsbSpeed::kFull, .settings = settings, .offers = large};
    EXPECT_EQ(plan_bandwidth(hungry, hungry, 0).together, Together::kNotAtAll);
}

TEST(Bandwidth, SuperSpeedCarriesTwoFullHdCameras)
{
    const std::vector<StreamOffer> offers{{mode(PixelFormat::kYuyv, 1920, 1080, k30), 0}};
    const std::vector<AlternateSetting> settings{{1, 1024, 1}, {2, 16 * 1024, 1}, {3, 3 * 16 * 1024, 1}};
    const BusUser user{.bus = 4, .speed = UsbSpeed::kSuper, .settings = settings, .offers = offers};
    const BandwidthPlan plan = plan_bandwidth(user, user, 0);
    EXPECT_EQ(plan.together, Together::kAtOnce);
    EXPECT_EQ(plan.left.alternate, 2);
}

TEST(Bandwidth, BulkReservesNothingButHasToPass)
{
    BusUser bulk = webcam(1);
    bulk.bulk = true;
    bulk.settings = {};
    const BandwidthPlan both = plan_bandwidth(bulk, bulk, 0);
    EXPECT_EQ(both.together, Together::kAtOnce);
    EXPECT_EQ(both.left.mode.interval_100ns, k30) << "2 x (2704 + 5 x 55) = 5958 <= 6000";
    EXPECT_EQ(both.left.reserved_bytes_per_s, 0U);
    const BandwidthPlan mixed = plan_bandwidth(bulk, webcam(1), 0);
    EXPECT_EQ(mixed.left.mode.interval_100ns, k15) << "2979 + 3250 > 6000";
    EXPECT_GT(mixed.right.reserved_bytes_per_s, 0U);
}

TEST(Bandwidth, CamerasWithoutASharedWireAlwaysFit)
{
    BusUser board = webcam(-1);
    board.settings = {};
    const BandwidthPlan plan = plan_bandwidth(board, board, 0);
    EXPECT_EQ(plan.together, Together::kAtOnce);
    EXPECT_STREQ(plan.why, "YUYV 640x480 at 30.0/s, both at once: no bus is shared");
}

TEST(Bandwidth, UnlikeCamerasMeetInTheFormatSizeAndRateThatBothHave)
{
    const std::vector<StreamOffer> left{{mode(PixelFormat::kYuyv, 800, 600, k30), 0},
                                        {mode(PixelFormat::kYuyv, 640, 480, k30), 0},
                                        {mode(PixelFormat::kYuyv, 640, 480, k15), 0}};
    const std::vector<StreamOffer> right{{mode(PixelFormat::kMjpeg, 640, 480, k30), 0},
                                         {mode(PixelFormat::kYuyv, 640, 480, 666667), 0}};
    const BandwidthPlan plan = plan_bandwidth(webcam(1, left), webcam(2, right), 0);
    EXPECT_EQ(plan.left.mode, left[2].mode);
    EXPECT_EQ(plan.right.mode, right[1].mode);

    const std::vector<StreamOffer> other{{mode(PixelFormat::kNv12, 640, 480, k30), 0}};
    const BandwidthPlan none = plan_bandwidth(webcam(1, left), webcam(2, other), 0);
    EXPECT_EQ(none.together, Together::kNotAtAll);
    EXPECT_THAT(none.why, HasSubstr("no format and size in common"));
    const BandwidthPlan empty = plan_bandwidth(webcam(1, left), webcam(2, {}), 0);
    EXPECT_THAT(empty.why, HasSubstr("the right camera offers no mode"));
}

TEST(Bandwidth, AModeThatNoSettingCarriesIsNamed)
{
    const std::vector<StreamOffer> offers{{mode(PixelFormat::kYuyv, 1280, 720, k30), 0},
                                          {mode(PixelFormat::kYuyv, 1280, 720, k5), 0}};
    const BandwidthPlan plan = plan_bandwidth(webcam(1, offers), webcam(1, offers), 0);
    EXPECT_EQ(plan.left.mode, offers[1].mode);
    EXPECT_THAT(plan.why, HasSubstr("no alternate setting carries YUYV 1280x720 at 30.0/s"));
}

TEST(Bandwidth, ASettingThatComesEverySecondMicroframeCarriesHalf)
{
    const std::vector<AlternateSetting> settings{{1, 1024, 2}, {2, 1280, 1}};
    const std::vector<StreamOffer> offers{{mode(PixelFormat::kYuyv, 640, 480, k10), 0}};
    const BusUser user{.bus = 1, .settings = settings, .offers = offers};
    EXPECT_EQ(plan_bandwidth(user, user, 0).left.alternate, 2) << "780 bytes are needed, 512 come";
}

class Dice
{
public:
    explicit Dice(std::uint32_t seed) : random_(seed) {}
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_()) % n; }

    std::vector<AlternateSetting> settings()
    {
        std::vector<AlternateSetting> made(below(12));
        for (AlternateSetting& one : made)
            one = {static_cast<std::uint8_t>(below(256)), below(4) == 0 ? below(60000) : below(3073), below(3)};
        return made;
    }
    std::vector<StreamOffer> offers()
    {
        static constexpr std::array<std::pair<int, int>, 4> kSizes{{{640, 480}, {1280, 720}, {160, 120}, {-1, 70000}}};
        static constexpr std::array<std::uint32_t, 6> kIntervals{k30, k15, k10, k5, 0, 1};
        std::vector<StreamOffer> made(below(10));
        for (StreamOffer& one : made) {
            const auto [width, height] = kSizes[below(8) == 0 ? 3 : below(3)];
            one.mode = mode(static_cast<PixelFormat>(below(5)), width, height, kIntervals[below(6)]);
            one.payload_bytes = below(3) == 0 ? below(4000) : 0;
        }
        return made;
    }

private:
    std::mt19937 random_;
};

/// USB 2.0, 5.11.3, in rational numbers and apart from the product.
double byte_times(double bytes, UsbSpeed speed)
{
    if (speed == UsbSpeed::kSuper)
        return bytes;
    return bytes * 7 / 6 + (speed == UsbSpeed::kHigh ? 38 : 9) * (bytes > 0 ? 1 : 0);
}

TEST(Bandwidth, WhateverTheCamerasSayThePlanFitsTheLadderDescendsAndEnds)
{
    for (std::uint32_t seed = 1; seed <= 4000; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Dice dice{seed};
        const auto settings_left = dice.settings();
        const auto settings_right = dice.settings();
        const auto offers_left = dice.offers();
        const auto offers_right = dice.below(2) == 0 ? offers_left : dice.offers();
        const auto speed = static_cast<UsbSpeed>(dice.below(3));
        const auto user = [&](const auto& settings, const auto& offers) {
            const int bus = static_cast<int>(dice.below(3)) - 1;
            return BusUser{.bus = bus,
                           .speed = speed,
                           .bulk = dice.below(4) == 0,
                           .chooses_alternate = dice.below(2) == 0,
                           .settings = settings,
                           .offers = offers};
        };
        const BusUser left = user(settings_left, offers_left);
        const BusUser right = user(settings_right, offers_right);
        const double budget = speed == UsbSpeed::kFull ? 1350 : speed == UsbSpeed::kHigh ? 6000 : 56250;
        const double per_s = speed == UsbSpeed::kFull ? 1000 : 8000;
        std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
        int refused = 0;
        for (;; ++refused) {
            ASSERT_LT(refused, 1000) << "the ladder has no end";
            const BandwidthPlan plan = plan_bandwidth(left, right, refused);
            ASSERT_STRNE(plan.why, "");
            if (plan.together == Together::kNotAtAll)
                break;
            const auto offered = [](const BusUser& by, const CameraMode& what) {
                for (const StreamOffer& one : by.offers)
                    if (one.mode == what)
                        return true;
                return false;
            };
            ASSERT_TRUE(offered(left, plan.left.mode) && offered(right, plan.right.mode));
            ASSERT_EQ(plan.left.mode.format, plan.right.mode.format);
            ASSERT_EQ(plan.left.mode.width, plan.right.mode.width);
            ASSERT_EQ(plan.left.mode.height, plan.right.mode.height);
            const bool at_once = plan.together == Together::kAtOnce;
            const std::uint64_t all = at_once ? std::uint64_t{plan.left.bus_time} + plan.right.bus_time
                                              : std::max(plan.left.bus_time, plan.right.bus_time);
            ASSERT_LT(all, last);
            last = all;
            const double l = byte_times(static_cast<double>(plan.left.reserved_bytes_per_s) / per_s, speed);
            const double r = byte_times(static_cast<double>(plan.right.reserved_bytes_per_s) / per_s, speed);
            ASSERT_LE(l, budget);
            ASSERT_LE(r, budget);
            const bool shared = at_once && left.bus >= 0 && left.bus == right.bus;
            ASSERT_LE(shared ? l + r : 0, budget);
        }
        const BandwidthPlan beyond = plan_bandwidth(left, right, refused + 1);
        ASSERT_EQ(beyond.together, Together::kNotAtAll);
    }
}

} // namespace
} // namespace dicot
