#include "probe_report.h"

#include "uvc_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

UvcListed c270_at(const char* port, const char* name = "HD Webcam C270")
{
    UvcListed listed;
    listed.device = parse_uvc_device(test::c270_bytes().bytes(), 1).value();
    listed.identity.driver = "uvc";
    listed.identity.port.assign(port, std::strlen(port));
    listed.identity.name.assign(name, std::strlen(name));
    listed.identity.serial.assign("2A01", 4);
    listed.identity.vendor = 0x046D;
    listed.identity.product = 0x0825;
    listed.bus = 1;
    return listed;
}

V4l2Nodes nodes_at(std::initializer_list<const char*> ports)
{
    V4l2Nodes nodes;
    for (const char* port : ports) {
        V4l2Node& node = nodes.nodes[static_cast<std::size_t>(nodes.count)];
        std::snprintf(node.path, sizeof node.path, "/dev/video%d", 2 * nodes.count++);
        node.identity.port.assign(port, std::strlen(port));
        node.identity.driver = "v4l2";
    }
    return nodes;
}

nlohmann::json json_of(const std::vector<SeenCamera>& cameras)
{
    return nlohmann::json::parse(probe_json(cameras, choose_rig(cameras), 0, {}));
}

// At 30 a second YUYV fills 2304 + 12 bytes of a microframe, which alternate setting 10 holds (3 x 896): twice
// 3136 + 3 x 38 byte times of 6000. At 25 it is 1932, in setting 9 (2 x 992): twice 2315 + 2 x 38.
constexpr const char* kPlanOfTwoC270s =
    "YUYV 640x480 at 25.0/s, both at once: takes 79 % of what may be reserved on bus 1, "
    "where YUYV 640x480 at 30.0/s would take 108 %";

TEST(Probe, TwoCamerasOnOneBusAreARigWithItsPlan)
{
    const std::vector<UvcListed> listed{c270_at("1-2"), c270_at("1-1")};
    const std::vector<SeenCamera> cameras = seen_cameras({}, listed);
    const RigChoice choice = choose_rig(cameras);
    const std::string text = probe_text(cameras, choice);
    EXPECT_THAT(text, HasSubstr(std::string{"left 1-1, right 1-2 (the first two ports): "} + kPlanOfTwoC270s + "\n"));
    EXPECT_THAT(text, HasSubstr("1-1: HD Webcam C270, 046d:0825, serial 2A01, driver uvc\n"));
    EXPECT_THAT(text, HasSubstr("MJPEG 1280 x 960  at 30, 25, 20, 15, 10, 5 /s\n"));
    EXPECT_THAT(text, HasSubstr(" 10: 2688 11: 3060\n"));

    const nlohmann::json report = json_of(cameras);
    ASSERT_EQ(report["cameras"].size(), 2u);
    EXPECT_EQ(report["cameras"][0]["port"], "1-1");
    EXPECT_EQ(report["cameras"][0]["ids"], "046d:0825");
    EXPECT_EQ(report["cameras"][0]["modes"].size(), 26u);
    EXPECT_EQ(report["cameras"][0]["usb"]["alternate_settings"][9]["bytes_per_interval"], 2688);
    EXPECT_TRUE(report["cameras"][0]["problem"].is_null());
    EXPECT_EQ(report["why"], kPlanOfTwoC270s);
    EXPECT_EQ(report["rig"]["together"], "at once");
    EXPECT_EQ(report["rig"]["right"]["port"], "1-2");
    EXPECT_EQ(report["rig"]["right"]["mode"]["interval_100ns"], 400'000);
    EXPECT_EQ(report["rig"]["right"]["alternate_setting"], 9);
    EXPECT_EQ(report["rig"]["right"]["reserved_bytes_per_s"], 1984 * 8000);
}

TEST(Probe, WhatTheDeviceAskedForCountsMoreThanTheEstimate)
{
    std::vector<SeenCamera> cameras = seen_cameras({}, std::vector<UvcListed>{c270_at("1-1"), c270_at("1-2")});
    for (SeenCamera& camera : cameras)
        camera.payload_bytes.assign(camera.modes.size(), 800);
    const nlohmann::json report = json_of(cameras);
    EXPECT_EQ(report["rig"]["left"]["alternate_setting"], 5); // 1 x 800
    EXPECT_EQ(report["rig"]["left"]["mode"]["interval_100ns"], 333'333);
    EXPECT_EQ(report["cameras"][1]["modes"][0]["payload_bytes"], 800);
}

TEST(Probe, ThePreferredModeDoesNotHangOnTheOrderOfTheDescriptors)
{
    std::vector<SeenCamera> cameras = seen_cameras({}, std::vector<UvcListed>{c270_at("1-1"), c270_at("2-1")});
    cameras[1].bus = 2;
    for (SeenCamera& camera : cameras)
        camera.modes = {{PixelFormat::kMjpeg, 1280, 960, 333'333},
                        {PixelFormat::kMjpeg, 640, 480, 333'333},
                        {PixelFormat::kYuyv, 160, 120, 333'333},
                        {PixelFormat::kYuyv, 640, 480, 666'667},
                        {PixelFormat::kYuyv, 640, 480, 333'333}};
    EXPECT_THAT(choose_rig(cameras).why, HasSubstr("YUYV 640x480 at 30.0/s, both at once"));
    EXPECT_THAT(probe_text(cameras, choose_rig(cameras)), HasSubstr("YUYV   640 x 480  at 15, 30 /s\n"));
}

TEST(Probe, ANodeOfTheKernelIsPreferredAndKeepsWhatTheDescriptorsSay)
{
    const std::vector<UvcListed> listed{c270_at("1-1"), c270_at("1-2")};
    // The second node of a device is its infrared picture.
    const std::vector<SeenCamera> cameras = seen_cameras(nodes_at({"1-2", "1-2", "platform:vivid-000"}), listed);
    ASSERT_EQ(cameras.size(), 3u);
    EXPECT_STREQ(cameras[0].identity.driver, "uvc");
    EXPECT_EQ(cameras[0].node, "");
    EXPECT_STREQ(cameras[1].identity.driver, "v4l2");
    EXPECT_EQ(cameras[1].node, "/dev/video0");
    EXPECT_STREQ(cameras[1].identity.serial.text, "2A01");
    EXPECT_EQ(cameras[1].settings.size(), 11u);
    EXPECT_EQ(cameras[2].node, "/dev/video4");
    EXPECT_TRUE(json_of(cameras)["cameras"][2]["usb"].is_null());
}

TEST(Probe, ACameraThatDoesNotOpenIsNamedWithTheReason)
{
    std::vector<SeenCamera> cameras = seen_cameras({}, std::vector<UvcListed>{c270_at("1-1"), c270_at("1-2")});
    cameras[1].problem = failure(Fault::kUnavailable, "another program has it");
    const RigChoice choice = choose_rig(cameras);
    EXPECT_THAT(probe_text(cameras, choice), HasSubstr("cannot be used: another program has it\n"));
    EXPECT_EQ(choice.why, std::string{kPlanOfTwoC270s} + "; but first the camera at 1-2 has to open");
    EXPECT_EQ(json_of(cameras)["cameras"][1]["problem"], "another program has it");
}

TEST(Probe, ADamagedCameraIsShownAndNotChosen)
{
    UvcListed damaged;
    damaged.identity.port.assign("1-1", 3);
    damaged.bus = 1;
    damaged.unusable = failure(Fault::kBadData, "descriptors end at byte 100");
    const std::vector<SeenCamera> cameras =
        seen_cameras({}, std::vector<UvcListed>{damaged, c270_at("1-2"), c270_at("1-3")});
    const RigChoice choice = choose_rig(cameras);
    ASSERT_NE(choice.right, nullptr);
    EXPECT_STREQ(choice.left->identity.port.text, "1-2");
    EXPECT_STREQ(choice.right->identity.port.text, "1-3");
    EXPECT_THAT(probe_text(cameras, choice), HasSubstr("cannot be used: descriptors end at byte 100\n"));
    EXPECT_TRUE(json_of(cameras)["cameras"][0]["ids"].is_null());
}

TEST(Probe, OneCameraIsNoRig)
{
    const std::vector<SeenCamera> cameras = seen_cameras({}, std::vector<UvcListed>{c270_at("1-1")});
    const RigChoice choice = choose_rig(cameras);
    EXPECT_THAT(choice.why, HasSubstr("only the camera at 1-1 can be used, and a rig needs two; plug in"));
    EXPECT_THAT(probe_text(cameras, choice), Not(HasSubstr("right")));
    EXPECT_TRUE(json_of(cameras)["rig"].is_null());
}

TEST(Probe, ANameOfAnyBytesLeavesTheReportReadable)
{
    const std::vector<SeenCamera> cameras =
        seen_cameras({}, std::vector<UvcListed>{c270_at("1-1", "\x1b[31m\"red\\\"\xff\n%s"), c270_at("1-2")});
    EXPECT_EQ(json_of(cameras)["cameras"][0]["name"], "?[31m\"red\\\"??%s");
    EXPECT_THAT(probe_text(cameras, choose_rig(cameras)), HasSubstr("1-1: ?[31m\"red\\\"??%s, 046d:0825"));
}

TEST(Probe, ControlsTellTheirRangeAndTheirValueIfTheyHaveOne)
{
    std::vector<SeenCamera> cameras = seen_cameras({}, std::vector<UvcListed>{c270_at("1-1")});
    cameras[0].controls = {{{ControlId::kGain, 0, 255, 1, 64}, 32}, {{ControlId::kFocus, 0, 250, 5, 0}, {}}};
    const std::string text = probe_text(cameras, choose_rig(cameras));
    EXPECT_THAT(text, HasSubstr("gain                 0 .. 255, step 1, usual 64, now 32\n"));
    EXPECT_THAT(text, HasSubstr("focus                0 .. 250, step 5, usual 0, now not told\n"));
    const nlohmann::json controls = json_of(cameras)["cameras"][0]["controls"];
    EXPECT_EQ(controls[0]["now"], 32);
    EXPECT_TRUE(controls[1]["now"].is_null());
}

TEST(Probe, NoCameraComesWithTheRemedy)
{
    EXPECT_EQ(no_camera(true, 0).exit_code(), 69);
    EXPECT_THAT(no_camera(true, 0).message(), HasSubstr("plug in two webcams"));
    EXPECT_THAT(no_camera(false, 0).message(), HasSubstr("recorded pairs (replay)"));
    EXPECT_THAT(no_camera(false, 3).message(), HasSubstr("add it to the group video"));
}

} // namespace
} // namespace dicot::app
