#include "descriptors.h"

#include <linux/usb/ch9.h>
#include <linux/usb/functionfs.h>

namespace dicot::gadget_parts {
namespace {

constexpr unsigned kStillImage = 6, kCapture = 1, kPtp = 1;
/// Of the descriptors for super speed: a burst of 16 packets is what the hardware may do at most.
constexpr unsigned kBulkBurst = 15;

} // namespace

void DescriptorBlock::put8(unsigned value) noexcept
{
    bytes_[size_++] = static_cast<std::byte>(value);
}

void DescriptorBlock::put16(unsigned value) noexcept
{
    put8(value & 0xff);
    put8(value >> 8 & 0xff);
}

void DescriptorBlock::put32(std::uint32_t value) noexcept
{
    put16(value & 0xffff);
    put16(value >> 16);
}

void DescriptorBlock::interface() noexcept
{
    for (const unsigned value :
         {unsigned{USB_DT_INTERFACE_SIZE}, unsigned{USB_DT_INTERFACE}, 0U, 0U, 3U, kStillImage, kCapture, kPtp, 1U})
        put8(value);
}

void DescriptorBlock::endpoint(unsigned address, unsigned type, unsigned packet, unsigned interval) noexcept
{
    put8(USB_DT_ENDPOINT_SIZE);
    put8(USB_DT_ENDPOINT);
    put8(address);
    put8(type);
    put16(packet);
    put8(interval);
}

void DescriptorBlock::companion(unsigned burst, unsigned bytes_per_interval) noexcept
{
    put8(USB_DT_SS_EP_COMP_SIZE);
    put8(USB_DT_SS_ENDPOINT_COMP);
    put8(burst);
    put8(0);
    put16(bytes_per_interval);
}

DescriptorBlock::DescriptorBlock(std::uint16_t os_version) noexcept
{
    put32(FUNCTIONFS_DESCRIPTORS_MAGIC_V2);
    put32(0); // the length, at the end
    put32(FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC | FUNCTIONFS_HAS_SS_DESC | FUNCTIONFS_HAS_MS_OS_DESC);
    put32(4);
    put32(4);
    put32(7); // each endpoint with its companion
    put32(1);
    // Full speed: packets of 64 bytes, events each 32 ms; from high speed on the interval is 2^(n-1) microframes.
    struct Speed
    {
        unsigned packet, interval;
        bool super;
    };
    for (const Speed speed : {Speed{64, 32, false}, Speed{512, 9, false}, Speed{1024, 9, true}}) {
        interface();
        endpoint(kBulkInAddress, USB_ENDPOINT_XFER_BULK, speed.packet, 0);
        if (speed.super)
            companion(kBulkBurst, 0);
        endpoint(kBulkOutAddress, USB_ENDPOINT_XFER_BULK, speed.packet, 0);
        if (speed.super)
            companion(kBulkBurst, 0);
        endpoint(kEventsAddress, USB_ENDPOINT_XFER_INT, kEventPacket, speed.interval);
        if (speed.super)
            companion(0, kEventPacket);
    }
    // Windows takes its MTP driver for a device that says so, without an .inf file.
    constexpr std::uint32_t kOsHeader = 11, kCompatible = 24;
    put8(0);
    put32(kOsHeader + kCompatible);
    put16(os_version);
    put16(4);
    put8(1);
    put8(0);
    put8(0);
    put8(1);
    for (const char letter : {'M', 'T', 'P', '\0', '\0', '\0', '\0', '\0'})
        put8(static_cast<unsigned char>(letter));
    for (int i = 0; i < 8 + 6; ++i)
        put8(0);
    const std::size_t size = size_;
    size_ = 4;
    put32(static_cast<std::uint32_t>(size));
    size_ = size;
}

std::span<const std::byte> interface_string() noexcept
{
    // magic, length, one string, one language; 0x0409, "MTP"
    static constexpr std::array<unsigned char, 22> kBytes{
        FUNCTIONFS_STRINGS_MAGIC, 0, 0, 0, 22, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0x09, 0x04, 'M', 'T', 'P', 0};
    return std::as_bytes(std::span(kBytes));
}

} // namespace dicot::gadget_parts
