// Which cameras of the USB Video Class are plugged in, told without opening any.
#pragma once

#include "dicot/base/status.h"
#include "dicot/camera/camera.h"
#include "dicot/uvc_parse/descriptors.h"

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace dicot {

struct UvcListed
{
    CameraIdentity identity;
    UvcDevice device;
    int bus = 0;
    int address = 0; ///< of the device on its bus; another one after each plugging in
    UsbSpeed speed = UsbSpeed::kHigh;
    Status unusable; ///< why a camera that is there cannot be used; `device` is then empty
};

/// A device descriptor and the longest configuration that wTotalLength can tell.
constexpr std::size_t kMostUsbDescriptorBytes = 18 + 65535;

/// Where Linux lists its USB devices.
constexpr const char* kUsbDevices = "/sys/bus/usb/devices";

/// The cameras in order of their ports. Needs no rights: names and descriptors are what the kernel read when the device
/// was plugged in. Devices without a video interface are not listed; one whose descriptors are damaged is, with the
/// reason. Fault::kUnavailable: this system has no such folder.
Result<std::vector<UvcListed>> list_uvc_cameras(const char* folder = kUsbDevices);

/// The camera at USB port path `which` ("1-1.2"), or else the only one with this serial number. Fault::kUnavailable:
/// there is none, it cannot be used, or two have this serial number; the sentence says what is there instead.
Result<UvcListed> find_uvc_camera(std::string_view which, const char* folder = kUsbDevices);

/// The camera at this port as it is now, without the heap; `room` takes its descriptors. Faults as above.
Result<UvcListed> look_at_port(const char* port, std::span<std::byte> room, const char* folder = kUsbDevices) noexcept;

} // namespace dicot
