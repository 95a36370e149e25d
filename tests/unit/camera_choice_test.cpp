#include "cameras/camera_choice.h"
#include "cameras/drawn_pair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

SeenCamera camera(const char* port, const char* serial = "", Status problem = {})
{
    SeenCamera seen;
    seen.identity.port.assign(port, std::strlen(port));
    seen.identity.serial.assign(serial, std::strlen(serial));
    seen.problem = problem;
    return seen;
}

CamerasConfig bound(CameraBinding left, CameraBinding right)
{
    CamerasConfig config;
    config.left = std::move(left);
    config.right = std::move(right);
    return config;
}

const CameraBinding kFirst{};
CameraBinding port(const char* text)
{
    return {BoundBy::kPort, text};
}
CameraBinding serial(const char* text)
{
    return {BoundBy::kSerial, text};
}

/// "LEFT RIGHT" by port, or the sentence.
std::string choice(const CamerasConfig& config, const std::vector<SeenCamera>& seen)
{
    const Result<ChosenCameras> chosen = choose_cameras(config, seen);
    if (!chosen.ok()) {
        EXPECT_EQ(chosen.status().fault(), Fault::kUnavailable);
        return chosen.status().message();
    }
    return std::string(chosen.value().left->identity.port.text) + " " + chosen.value().right->identity.port.text;
}

TEST(CameraChoice, EachSideIsFoundByPortSerialOrOrder)
{
    const std::vector<SeenCamera> seen{camera("1-1", "AA"), camera("1-2", "BB"), camera("1-3", "CC")};
    EXPECT_EQ(choice(bound(kFirst, kFirst), seen), "1-1 1-2");
    EXPECT_EQ(choice(bound(port("1-3"), port("1-1")), seen), "1-3 1-1");
    EXPECT_EQ(choice(bound(serial("BB"), serial("AA")), seen), "1-2 1-1");
    EXPECT_EQ(choice(bound(port("1-1"), kFirst), seen), "1-1 1-2");
    EXPECT_EQ(choice(bound(kFirst, port("1-1")), seen), "1-2 1-1");
    EXPECT_EQ(choice(bound(kFirst, serial("BB")), seen), "1-1 1-2");
}

TEST(CameraChoice, WhatIsMissingIsNamedWithWhatIsThere)
{
    const std::vector<SeenCamera> seen{camera("1-1", "AA"), camera("1-2")};
    EXPECT_THAT(choice(bound(port("2-4"), kFirst), seen),
                HasSubstr("cameras.left: there is no camera '2-4'; there are: 1-1 (serial AA), 1-2"));
    EXPECT_THAT(choice(bound(kFirst, serial("ZZ")), seen), HasSubstr("cameras.right: there is no camera 'ZZ'"));
    EXPECT_THAT(choice(bound(kFirst, kFirst), {camera("1-1")}), HasSubstr("cameras.right: no camera is left"));
    EXPECT_THAT(choice(bound(serial("AA"), kFirst), {camera("1-1", "AA"), camera("1-2", "AA")}),
                HasSubstr("two cameras have the serial number AA, at 1-1 and 1-2"));
}

TEST(CameraChoice, ACameraWithAProblemIsPassedOverUnlessItIsNamed)
{
    const std::vector<SeenCamera> seen{camera("1-1", "", failure(Fault::kUnavailable, "its descriptors are damaged")),
                                       camera("1-2"), camera("1-3")};
    EXPECT_EQ(choice(bound(kFirst, kFirst), seen), "1-2 1-3");
    EXPECT_THAT(choice(bound(port("1-1"), kFirst), seen), HasSubstr("its descriptors are damaged"));
}

TEST(CameraChoice, TheKernelsDriverIsPreferredWhereItHasTheCamera)
{
    SeenCamera with_node = camera("1-1");
    with_node.node = "/dev/video0";
    EXPECT_TRUE(opens_through_kernel(with_node, "auto"));
    EXPECT_FALSE(opens_through_kernel(camera("1-1"), "auto"));
    EXPECT_FALSE(opens_through_kernel(with_node, "uvc"));
    EXPECT_TRUE(opens_through_kernel(camera("1-1"), "v4l2"));
}

/// A camera that is nothing but its list of modes.
class Listed final : public Camera
{
public:
    explicit Listed(std::vector<CameraMode> modes) : modes_(std::move(modes)) {}
    const CameraIdentity& identity() const noexcept override { return identity_; }
    std::span<const CameraMode> modes() const noexcept override { return modes_; }
    std::span<const ControlRange> controls() const noexcept override { return {}; }
    Result<std::int32_t> get(ControlId) override { return none(); }
    Result<std::int32_t> set(ControlId, std::int32_t) override { return none(); }
    Status start(const CameraMode&) override { return none(); }
    Result<FrameLease> next(std::int64_t) override { return none(); }
    Status stop() override { return {}; }
    Status shake(Shake) override { return none(); }
    void give_back(int) noexcept override {}

private:
    static Status none() { return failure(Fault::kUnavailable, "a list"); }
    CameraIdentity identity_;
    std::vector<CameraMode> modes_;
};

std::vector<std::string> offered(const CamerasConfig& config, const std::vector<CameraMode>& modes)
{
    const Listed camera(modes);
    const Result<std::vector<StreamOffer>> offers = offers_for(config, camera);
    if (!offers.ok())
        return {offers.status().message()};
    std::vector<std::string> words;
    for (const StreamOffer& offer : offers.value())
        words.push_back(std::string(name_of(offer.mode.format)) + " " + std::to_string(offer.mode.interval_100ns));
    return words;
}

TEST(CameraChoice, ModesAreInTheOrderOfTheConfiguration)
{
    using enum PixelFormat;
    const std::vector<CameraMode> modes{{kMjpeg, 640, 480, 333333}, {kMjpeg, 640, 480, 166666},
                                        {kYuyv, 640, 480, 666666},  {kYuyv, 640, 480, 333667},
                                        {kYuyv, 320, 240, 333333},  {kGrey, 640, 480, 333333}};
    CamerasConfig config;
    EXPECT_THAT(offered(config, modes),
                ElementsAre("YUYV 333667", "YUYV 666666", "MJPEG 333333", "MJPEG 166666", "GREY 333333"));
    config.formats = {kMjpeg};
    config.fps = 15;
    EXPECT_THAT(offered(config, modes), ElementsAre("MJPEG 166666", "MJPEG 333333"));
    config.width = 1280;
    config.height = 720;
    EXPECT_THAT(offered(config, modes),
                ElementsAre(HasSubstr("has no mode of 1280 x 720 px in the configured formats; it has: "
                                      "GREY 640x480, MJPEG 640x480, YUYV 320x240, YUYV 640x480")));
}

TEST(DrawnPair, WhatIsSeenTwiceIsAlike)
{
    std::vector<Rgb8> pixels(2 * std::size_t{DrawnPair::kWidth} * DrawnPair::kHeight);
    const ImageView<Rgb8> left{pixels.data(), DrawnPair::kWidth, DrawnPair::kHeight};
    const ImageView<Rgb8> right{pixels.data() + pixels.size() / 2, DrawnPair::kWidth, DrawnPair::kHeight};
    DrawnPair::draw(left, right);
    EXPECT_EQ(left.at(300, 10), right.at(300 - 24, 10));   // the wall
    EXPECT_EQ(left.at(190, 120), right.at(190 - 60, 120)); // the nearest leaf
}

} // namespace
} // namespace dicot::app
