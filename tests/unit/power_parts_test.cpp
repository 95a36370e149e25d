// What rest is made of: the mark, the leads, the cameras' ports, the rules of a configuration.
#include "dicot/power/cameras_power.h"
#include "dicot/power/lead_time.h"
#include "dicot/power/power_rules.h"
#include "dicot/power/rest_mark.h"

#include "config/config.h"
#include "temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <string>

namespace dicot::app {
namespace {

using test::TempFolder;
using testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000;
constexpr std::int64_t kMinute = 60 * kSecond;
constexpr std::int64_t kHour = 60 * kMinute;

TEST(RestMark, ComesBackAndIsNotMadeOfAnythingElse)
{
    RestMark mark{17, -3, 1'780'315'200 * kSecond, {}};
    std::strcpy(mark.boot.text, "01234567-89ab-cdef-0123-456789abcdef");
    const ShortText<200> text = text_of(mark);
    ASSERT_TRUE(parse_rest_mark(text.view()));
    EXPECT_EQ(*parse_rest_mark(text.view()), mark);
    for (std::size_t size = 0; size < text.view().size(); ++size)
        EXPECT_FALSE(parse_rest_mark(text.view().substr(0, size))) << size;
    EXPECT_FALSE(parse_rest_mark(std::string{text.view()} + "x"));
    EXPECT_FALSE(parse_rest_mark("rest slot=99999999999999999999 due_us=1 alarm_us=1 boot="));
}

TEST(LeadTime, IsTheLongestOfTheLastEightAndAQuarter)
{
    LeadTime lead;
    EXPECT_EQ(lead.of(LeadPart::kCameras), 30 * kSecond);
    EXPECT_TRUE(lead.note(LeadPart::kCameras, 40 * kSecond).ok());
    for (int i = 0; i < 7; ++i)
        EXPECT_TRUE(lead.note(LeadPart::kCameras, 8 * kSecond).ok());
    EXPECT_EQ(lead.of(LeadPart::kCameras), 51 * kSecond);
    EXPECT_TRUE(lead.note(LeadPart::kCameras, 4 * kSecond).ok());
    EXPECT_EQ(lead.of(LeadPart::kCameras), 11 * kSecond) << "the long one is forgotten";
    EXPECT_TRUE(lead.note(LeadPart::kCameras, 20 * kHour).ok());
    EXPECT_EQ(lead.of(LeadPart::kCameras), 10 * kMinute);
    EXPECT_EQ(lead.of(LeadPart::kBoot), 90 * kSecond) << "each part for itself";
}

TEST(LeadTime, IsKeptAndWrittenOnlyWhenItChanges)
{
    const TempFolder folder;
    {
        LeadTime lead;
        lead.open(folder.path("").c_str());
        EXPECT_TRUE(lead.note(LeadPart::kCameras, 12 * kSecond).ok());
        EXPECT_TRUE(std::filesystem::remove(folder.path("lead")));
        EXPECT_TRUE(lead.note(LeadPart::kCameras, 12 * kSecond).ok());
        EXPECT_FALSE(std::filesystem::exists(folder.path("lead"))) << "the same lead costs the card nothing";
        EXPECT_TRUE(lead.note(LeadPart::kCameras, 20 * kSecond).ok());
    }
    LeadTime next;
    next.open(folder.path("").c_str());
    EXPECT_EQ(next.of(LeadPart::kCameras), 26 * kSecond);
    EXPECT_EQ(next.text().view(), "cameras_ms 12000 12000 20000\nresume_ms\nboot_ms\n");
}

TEST(LeadTime, TakesTheDefaultsFromAFileThatIsDamaged)
{
    for (const char* text : {"", "\n\n", "cameras_ms", "cameras_ms x -5 99999999999999999999 1e3 900000000",
                             "camera_ms 5", "\xff\xfe cameras_ms 7", "cameras_ms  \n"}) {
        LeadTime lead;
        lead.parse(text);
        EXPECT_EQ(lead.of(LeadPart::kCameras), 30 * kSecond) << text;
    }
    LeadTime lead;
    lead.parse("boot_ms 5 x 40000");
    EXPECT_EQ(lead.of(LeadPart::kBoot), 51 * kSecond);
    lead.parse("boot_ms 1 2 3 4 5 6 7 8 9 10 1000");
    EXPECT_EQ(lead.of(LeadPart::kBoot), 2'250'000);
}

class PortFolders : public testing::Test
{
protected:
    PortFolders()
    {
        for (const char* port : {"1-1.1", "1-1.2"}) {
            std::filesystem::create_directories(sys_.path(std::string{"bus/usb/devices/"} + port + "/power"));
            write(port, "/power/control", "on\n");
            write(port, "/bConfigurationValue", "1\n");
        }
    }
    void write(const std::string& device, const std::string& file, const std::string& text)
    {
        sys_.write("bus/usb/devices/" + device + file, text);
    }
    std::string read(const std::string& file) const
    {
        const test::Bytes bytes = test::bytes_of(sys_.path("bus/usb/devices/" + file));
        return {bytes.begin(), bytes.end()};
    }
    void give_switches()
    {
        for (const char* port : {"1-1-port1", "1-1-port2"}) {
            std::filesystem::create_directories(sys_.path(std::string{"bus/usb/devices/1-1:1.0/"} + port));
            write("1-1:1.0/", std::string{port} + "/disable", "0\n");
        }
    }
    TempFolder sys_;
    std::string root_ = sys_.path("");
};

TEST_F(PortFolders, CamerasAreLeftToTheKernel)
{
    CamerasPower power{CamerasBetween::kAuto, root_.c_str()};
    EXPECT_TRUE(power.off().ok()) << "no cameras yet";
    ASSERT_TRUE(power.use("1-1.1", "1-1.2").ok());
    EXPECT_TRUE(power.on().ok());
    EXPECT_TRUE(power.off().ok());
    EXPECT_EQ(read("1-1.1/power/control"), "auto");
    EXPECT_EQ(read("1-1.2/power/control"), "auto");
}

TEST_F(PortFolders, CamerasAreSwitchedWithTheirPorts)
{
    give_switches();
    CamerasPower power{CamerasBetween::kPort, root_.c_str()};
    ASSERT_TRUE(power.use("1-1.1", "1-1.2").ok());
    write("1-1:1.0/", "1-1-port2/disable", "1\n"); // the process before this one was killed while they were off
    EXPECT_TRUE(power.on().ok());
    EXPECT_EQ(read("1-1:1.0/1-1-port2/disable"), "0");
    EXPECT_TRUE(power.off().ok());
    EXPECT_EQ(read("1-1:1.0/1-1-port1/disable"), "1");
    EXPECT_EQ(read("1-1:1.0/1-1-port2/disable"), "1");
    EXPECT_TRUE(power.on().ok());
    EXPECT_EQ(read("1-1:1.0/1-1-port1/disable"), "0");
}

TEST_F(PortFolders, AHubThatCannotSwitchIsToldOnceAndTheKernelHasThem)
{
    CamerasPower power{CamerasBetween::kPort, root_.c_str()};
    ASSERT_TRUE(power.use("1-1.1", "1-1.2").ok());
    const Status why = power.off();
    EXPECT_EQ(why.fault(), Fault::kUnavailable);
    EXPECT_THAT(why.message(), HasSubstr("1-1.1"));
    EXPECT_EQ(read("1-1.2/power/control"), "auto");
    EXPECT_TRUE(power.off().ok());
    EXPECT_TRUE(power.on().ok());
}

TEST(PowerRules, ComeFromTheConfiguration)
{
    Config config;
    EXPECT_EQ(rest_rules(config).between, Between::kIdle);
    EXPECT_EQ(cameras_between(config), CamerasBetween::kAuto);
    config.power.between = "off";
    config.power.cameras = "port";
    config.power.least_rest_s = 7;
    config.run.state = "/s";
    EXPECT_EQ(rest_rules(config).between, Between::kOff);
    EXPECT_EQ(rest_rules(config).least_rest_us, 7 * kSecond);
    EXPECT_EQ(rest_rules(config).state.view(), "/s");
    EXPECT_EQ(cameras_between(config), CamerasBetween::kPort);
}

} // namespace
} // namespace dicot::app
