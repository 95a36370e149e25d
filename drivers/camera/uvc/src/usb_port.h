// One opened device: its interfaces, its requests.
#pragma once

#include "usb_session.h"

#include "dicot/uvc/uvc_list.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace dicot {

/// bRequest of the class (UVC, table A-8).
enum class UvcRequest : std::uint8_t
{
    kSetCur = 0x01,
    kGetCur = 0x81,
    kGetMin = 0x82,
    kGetMax = 0x83,
    kGetRes = 0x84,
    kGetInfo = 0x86,
    kGetDef = 0x87,
};

/// A device file, its libusb handle and its claimed interfaces. All empty after close().
class UsbPort
{
public:
    static constexpr unsigned kRequestMs = 500;

    UsbPort() = default;
    UsbPort(const UsbPort&) = delete;
    UsbPort& operator=(const UsbPort&) = delete;
    ~UsbPort() { close(); }

    /// Opens the device, detaches the kernel's driver and claims both interfaces.
    Status open(const UvcListed& camera, const std::shared_ptr<UsbSession>& session);
    /// Lets go of the interfaces and lets the kernel's driver have them back.
    void close() noexcept;
    bool is_open() const noexcept { return handle_ != nullptr; }
    libusb_device_handle* handle() const noexcept { return handle_; }
    const char* name() const noexcept { return name_.text; }

    /// A request to an entity of the control interface (`entity` != 0) or to the streaming interface. Returns how many
    /// bytes went over, or a libusb error. `data` goes out with kSetCur and comes in with the others.
    int control(std::uint8_t entity, UvcRequest request, std::uint8_t selector, std::span<std::byte> data) noexcept;
    int streaming(UvcRequest request, std::uint8_t selector, std::span<std::byte> data) noexcept;

    /// 0, or a libusb error; `full` tells that the bus has no bandwidth left (ENOSPC).
    int set_alternate(std::uint8_t number, bool& full) noexcept;
    Status reset() noexcept;

private:
    int request(std::uint16_t index, UvcRequest request, std::uint8_t selector, std::span<std::byte> data) noexcept;

    std::shared_ptr<UsbSession> session_;
    DeviceText<31> name_;
    int file_ = -1;
    libusb_device_handle* handle_ = nullptr;
    std::uint8_t control_interface_ = 0;
    std::uint8_t streaming_interface_ = 0;
    bool has_control_ = false;
    bool has_streaming_ = false;
};

} // namespace dicot
