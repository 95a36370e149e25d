// Which devices that speak MTP or PTP are plugged in, told without opening any.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace dicot::mtp {

/// Where Linux lists its USB devices.
inline constexpr const char* kUsbDevices = "/sys/bus/usb/devices";

/// What a device says of itself; texts are printable.
struct MtpListed
{
    ShortText<31> port; ///< "1-1.4": bus and ports on the way
    ShortText<63> manufacturer, product, serial;
    std::uint16_t vendor_id = 0, product_id = 0;
    int bus = 0, address = 0; ///< address: another one after each plugging in

    std::uint8_t configuration = 0, interface = 0, alternate = 0;
    std::uint8_t bulk_out = 0, bulk_in = 0, events = 0; ///< endpoints; events: 0 if it has none
    std::uint16_t packet_bytes = 0;                     ///< of both bulk endpoints: 8 .. 1024
    bool may_open = false;                              ///< this user may write to its device file
};

/// Devices with an interface for still images (PTP, and MTP over it), or one of the vendor's own called "MTP", in order
/// of their ports; QEMU's, Android's and umtp-responder's among them. Needs no rights. Fault::kUnavailable: this system
/// lists no USB devices.
Result<std::vector<MtpListed>> list_mtp_devices(const char* folder = kUsbDevices);

/// The interface to speak MTP with, in the descriptors of one device: its active configuration alone is looked at.
/// `is_called_mtp` tells whether an interface's own name says so. False: it has none.
bool find_mtp_interface(std::span<const std::byte> descriptors, std::uint8_t active_configuration,
                        bool (*is_called_mtp)(void* asker, std::uint8_t interface), void* asker, MtpListed& listed);

} // namespace dicot::mtp
