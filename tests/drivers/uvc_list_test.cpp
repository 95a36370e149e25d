#include "dicot/uvc/uvc_list.h"

#include "temp_folder.h"
#include "uvc_bytes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace dicot {
namespace {

/// A folder as Linux lists its USB devices in.
class UsbDevices : public testing::Test
{
protected:
    void plug(const std::string& port, const std::vector<std::byte>& descriptors, const std::string& product,
              const std::string& serial, const std::string& speed = "480")
    {
        write(port, "descriptors", std::string(reinterpret_cast<const char*>(descriptors.data()), descriptors.size()));
        write(port, "product", product + "\n");
        if (!serial.empty())
            write(port, "serial", serial + "\n");
        write(port, "busnum", "1\n");
        write(port, "devnum", "17\n");
        write(port, "speed", speed + "\n");
        write(port, "bConfigurationValue", "1\n");
    }
    void write(const std::string& port, const std::string& name, const std::string& text)
    {
        std::filesystem::create_directories(folder_.path("devices/" + port));
        std::ofstream(folder_.path("devices/" + port + "/" + name), std::ios::binary) << text;
    }
    std::string folder() const { return folder_.path("devices"); }

    test::TempFolder folder_;
};

TEST_F(UsbDevices, CamerasAreListedByTheirPorts)
{
    plug("1-1.4", test::c920_bytes().bytes(), "HD Pro Webcam C920", "AB12", "480");
    plug("1-1.2", test::c270_bytes().bytes(), "Webcam C270", "", "480");
    test::DescriptorBytes disk;
    disk.device(1, 2).configuration(1, 1).interface(0, 0, 0, 8, 6).end_configuration();
    plug("1-1.3", disk.bytes(), "Disk", "");
    plug("usb1", test::c270_bytes().bytes(), "a root hub's name", "");
    plug("1-1.2:1.0", test::c270_bytes().bytes(), "an interface's name", "");
    const Result<std::vector<UvcListed>> listed = list_uvc_cameras(folder().c_str());
    ASSERT_TRUE(listed.ok()) << listed.status().message();
    ASSERT_EQ(listed.value().size(), 2u);
    const UvcListed& first = listed.value()[0];
    EXPECT_STREQ(first.identity.port.text, "1-1.2");
    EXPECT_STREQ(first.identity.name.text, "Webcam C270");
    EXPECT_STREQ(first.identity.serial.text, "");
    EXPECT_EQ(first.identity.vendor, 0x046D);
    EXPECT_EQ(first.identity.product, 0x0825);
    EXPECT_EQ(first.bus, 1);
    EXPECT_EQ(first.address, 17);
    EXPECT_EQ(first.speed, UsbSpeed::kHigh);
    EXPECT_TRUE(first.unusable.ok());
    EXPECT_EQ(first.device.frame_count, 5);
    EXPECT_STREQ(listed.value()[1].identity.port.text, "1-1.4");
}

TEST_F(UsbDevices, NamesAreMadePrintable)
{
    plug("1-1", test::c270_bytes().bytes(), "cam\x1b[2J\xC3\xA9", "");
    EXPECT_STREQ(list_uvc_cameras(folder().c_str()).value()[0].identity.name.text, "cam?[2J??");
}

TEST_F(UsbDevices, ADamagedCameraIsListedWithItsReason)
{
    std::vector<std::byte> cut = test::c270_bytes().bytes();
    cut.resize(cut.size() / 2);
    plug("2-1", cut, "Webcam", "");
    const Result<std::vector<UvcListed>> listed = list_uvc_cameras(folder().c_str());
    ASSERT_EQ(listed.value().size(), 1u);
    EXPECT_EQ(listed.value()[0].unusable.fault(), Fault::kBadData);
    const Result<UvcListed> found = find_uvc_camera("2-1", folder().c_str());
    EXPECT_NE(std::string{found.status().message()}.find("USB port 2-1 cannot be used"), std::string::npos);
}

TEST_F(UsbDevices, ACameraIsFoundByPortOrByTheSerialNumberThatItAloneHas)
{
    plug("1-1", test::c270_bytes().bytes(), "left", "SAME");
    plug("1-2", test::c270_bytes().bytes(), "right", "SAME");
    plug("1-3", test::c920_bytes().bytes(), "third", "OTHER");
    const std::string at = folder();
    EXPECT_STREQ(find_uvc_camera("1-2", at.c_str()).value().identity.name.text, "right");
    EXPECT_STREQ(find_uvc_camera("OTHER", at.c_str()).value().identity.name.text, "third");
    EXPECT_NE(std::string{find_uvc_camera("SAME", at.c_str()).status().message()}.find("2 cameras"), std::string::npos);
    const Result<UvcListed> none = find_uvc_camera("1-9", at.c_str());
    EXPECT_EQ(none.status().fault(), Fault::kUnavailable);
    EXPECT_NE(std::string{none.status().message()}.find("1-1, 1-2, 1-3"), std::string::npos);
    EXPECT_FALSE(find_uvc_camera("", at.c_str()).ok());
}

TEST_F(UsbDevices, OnePortIsLookedAtAgain)
{
    plug("1-1", test::c270_bytes().bytes(), "left", "SAME");
    const std::string at = folder();
    std::vector<std::byte> room(kMostUsbDescriptorBytes);
    const Result<UvcListed> there = look_at_port("1-1", room, at.c_str());
    ASSERT_TRUE(there.ok()) << there.status().message();
    EXPECT_STREQ(there.value().identity.name.text, "left");
    EXPECT_EQ(there.value().device.frame_count, 5);
    EXPECT_EQ(look_at_port("1-2", room, at.c_str()).status().fault(), Fault::kUnavailable);
    EXPECT_EQ(look_at_port("../x-1", room, at.c_str()).status().fault(), Fault::kUnavailable);
    EXPECT_EQ(look_at_port("1-1", std::span{room}.first(60), at.c_str()).status().fault(), Fault::kBadData);
}

TEST_F(UsbDevices, ASystemWithoutUsbSaysSo)
{
    const Result<std::vector<UvcListed>> listed = list_uvc_cameras((folder() + "/nowhere").c_str());
    EXPECT_EQ(listed.status().fault(), Fault::kUnavailable);
}

} // namespace
} // namespace dicot
