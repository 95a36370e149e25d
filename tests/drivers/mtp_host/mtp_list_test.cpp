#include "dicot/mtp_host/mtp_list.h"

#include "scripted_pipe.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace dicot::mtp {
namespace {

using test::bytes_of_hex;

const char* const kDevice = "12 01 0002 00 00 00 40  F446 0400 0000 01 02 03 01"; // 46F4:0004
const char* const kEndpoints =
    "07 05 81 02 0002 00  07 05 02 02 0002 00  07 05 83 03 4000 0A"; // 81 in, 02 out, 83 events

/// One configuration with these descriptors in it.
std::string configuration(const std::string& inside, const char* value = "01")
{
    return "09 02 2700 01" + std::string{value} + "02 C0 02" + inside;
}
const std::string kStillImage = "09 04 00 00 03 06 01 01 04" + std::string{kEndpoints};
const std::string kVendor = "09 04 01 00 03 FF FF 00 05" + std::string{kEndpoints};
const std::string kKeyboard = "09 04 00 00 01 03 01 01 00  07 05 81 03 0800 0A";

bool never(void*, std::uint8_t)
{
    return false;
}

bool find(const std::string& configurations, MtpListed& listed, bool (*called)(void*, std::uint8_t) = never)
{
    return find_mtp_interface(bytes_of_hex(kDevice + configurations), 1, called, nullptr, listed);
}

TEST(MtpInterface, OfStillImagesIsFoundWithItsEndpoints)
{
    MtpListed listed;
    ASSERT_TRUE(find(configuration(kKeyboard + kStillImage), listed));
    EXPECT_EQ(listed.interface, 0);
    EXPECT_EQ(listed.bulk_in, 0x81);
    EXPECT_EQ(listed.bulk_out, 0x02);
    EXPECT_EQ(listed.events, 0x83);
    EXPECT_EQ(listed.packet_bytes, 512);
}

TEST(MtpInterface, OfAVendorIsFoundByItsName)
{
    MtpListed listed;
    EXPECT_FALSE(find(configuration(kVendor), listed));
    const auto second = [](void*, std::uint8_t interface) { return interface == 1; };
    ASSERT_TRUE(find(configuration(kKeyboard + kVendor), listed, second));
    EXPECT_EQ(listed.interface, 1);
}

TEST(MtpInterface, OfAnotherConfigurationIsNotLookedAt)
{
    MtpListed listed;
    EXPECT_FALSE(find(configuration(kKeyboard) + configuration(kStillImage, "02"), listed));
    EXPECT_TRUE(find(configuration(kKeyboard, "02") + configuration(kStillImage), listed));
}

TEST(MtpInterface, ThatNoPipeFitsIsNone)
{
    MtpListed listed;
    const std::string head = "09 04 00 00 03 06 01 01 04";
    EXPECT_FALSE(find(configuration(head), listed));
    EXPECT_FALSE(find(configuration(head + "07 05 81 02 0002 00"), listed));                     // nothing goes out
    EXPECT_FALSE(find(configuration(head + "07 05 81 02 0002 00 07 05 02 02 4000 00"), listed)); // unlike packets
    EXPECT_FALSE(find(configuration(head + "07 05 81 02 0000 00 07 05 02 02 0000 00"), listed)); // of nothing
    EXPECT_FALSE(find(configuration(head + "07 05 81 02 0102 00 07 05 02 02 0102 00"), listed)); // of 513
    EXPECT_FALSE(find(configuration(head + kEndpoints + "07 05 84 02 0002 00"), listed));        // two ways in
    EXPECT_TRUE(find(configuration(head + "07 05 81 02 0004 00 07 05 02 02 0004 00"), listed));  // no events
    EXPECT_EQ(listed.events, 0);
}

TEST(MtpInterface, IsNotFoundInDescriptorsThatLie)
{
    const test::UsbBytes whole = bytes_of_hex(kDevice + configuration(kStillImage));
    MtpListed listed;
    // Whatever is cut: an end without its second pipe is none.
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const bool found = find_mtp_interface(std::span{whole}.first(length), 1, never, nullptr, listed);
        EXPECT_EQ(found, length >= whole.size() - 7) << length;
    }
    for (const unsigned length : {0u, 1u, 255u}) {
        test::UsbBytes wrong = whole;
        wrong[18 + 9] = static_cast<std::byte>(length); // of the interface
        EXPECT_FALSE(find_mtp_interface(wrong, 1, never, nullptr, listed)) << length;
    }
}

TEST(MtpDevices, AreListedAsTheKernelTellsOfThem)
{
    test::TempFolder folder;
    const auto write = [&](const std::string& device, const std::string& name, const std::string& text) {
        std::filesystem::create_directories(folder.path(device));
        std::ofstream(folder.path(device + "/" + name), std::ios::binary) << text;
    };
    const auto plug = [&](const std::string& port, const std::string& inside) {
        const test::UsbBytes bytes = bytes_of_hex(kDevice + configuration(inside));
        write(port, "descriptors", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        write(port, "bConfigurationValue", "1\n");
        write(port, "busnum", "1\n");
        write(port, "devnum", "250\n");
    };
    plug("1-1.4", kStillImage);
    write("1-1.4", "manufacturer", "QEMU\n");
    write("1-1.4", "product", "QEMU \x1b[31mfilesharing\n");
    write("1-1.4", "serial", "S7\n");
    plug("1-1.2", kVendor);
    write("1-1.2:1.1", "interface", "Android MTP\n");
    plug("1-1.3", kVendor);
    write("1-1.3:1.1", "interface", "ADB Interface\n");
    plug("1-1.5", kKeyboard);
    plug("usb1", kStillImage);
    plug("1-1.6", kStillImage);
    write("1-1.6", "bConfigurationValue", "\n"); // not configured

    const Result<std::vector<MtpListed>> listed = list_mtp_devices(folder.path(".").c_str());
    ASSERT_TRUE(listed.ok()) << listed.status().message();
    ASSERT_EQ(listed.value().size(), 2u);
    EXPECT_EQ(listed.value()[0].port.view(), "1-1.2");
    const MtpListed& second = listed.value()[1];
    EXPECT_EQ(second.port.view(), "1-1.4");
    EXPECT_EQ(second.manufacturer.view(), "QEMU");
    EXPECT_EQ(second.product.view(), "QEMU \xEF\xBF\xBD[31mfilesharing");
    EXPECT_EQ(second.serial.view(), "S7");
    EXPECT_EQ(second.vendor_id, 0x46F4);
    EXPECT_EQ(second.product_id, 0x0004);
    EXPECT_EQ(second.bus, 1);
    EXPECT_EQ(second.address, 250);
    EXPECT_EQ(list_mtp_devices("/nowhere/at/all").status().fault(), Fault::kUnavailable);
}

} // namespace
} // namespace dicot::mtp
