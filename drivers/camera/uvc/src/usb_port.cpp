#include "usb_port.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace dicot {

Status UsbPort::open(const UvcListed& camera, const std::shared_ptr<UsbSession>& session)
{
    close();
    session_ = session;
    name_ = camera.identity.port;
    char path[64];
    std::snprintf(path, sizeof path, "/dev/bus/usb/%03d/%03d", camera.bus, camera.address);
    file_ = ::open(path, O_RDWR | O_CLOEXEC);
    if (file_ < 0) {
        const int error = errno;
        return failure(Fault::kUnavailable, "the camera at USB port %s cannot be opened (%s: %s)%s", name_.text, path,
                       strerrordesc_np(error),
                       error == EACCES ? "; give this user its device file by a udev rule" : "");
    }
    if (const int error = libusb_wrap_sys_device(session_->context(), file_, &handle_); error != 0) {
        handle_ = nullptr;
        close();
        return usb_failure(name_.text, "open", error);
    }
    libusb_set_auto_detach_kernel_driver(handle_, 1);
    control_interface_ = camera.device.control_interface;
    streaming_interface_ = camera.device.streaming_interface;
    // Control first: the kernel's driver lets go of the streaming interface with it.
    int error = libusb_claim_interface(handle_, control_interface_);
    has_control_ = error == 0;
    if (error == 0) {
        error = libusb_claim_interface(handle_, streaming_interface_);
        has_streaming_ = error == 0;
    }
    if (error != 0) {
        const Status why = usb_failure(name_.text, "claim its interfaces", error);
        close();
        return why;
    }
    return {};
}

void UsbPort::close() noexcept
{
    if (handle_ != nullptr) {
        // Streaming first: the kernel's driver binds to the control interface and then asks for the other one.
        if (has_streaming_)
            libusb_release_interface(handle_, streaming_interface_);
        if (has_control_)
            libusb_release_interface(handle_, control_interface_);
        libusb_close(handle_);
    }
    has_streaming_ = false;
    has_control_ = false;
    handle_ = nullptr;
    if (file_ >= 0)
        ::close(file_);
    file_ = -1;
    session_.reset();
}

int UsbPort::control(std::uint8_t entity, UvcRequest wanted, std::uint8_t selector, std::span<std::byte> data) noexcept
{
    return request(static_cast<std::uint16_t>(entity << 8 | control_interface_), wanted, selector, data);
}

int UsbPort::streaming(UvcRequest wanted, std::uint8_t selector, std::span<std::byte> data) noexcept
{
    return request(streaming_interface_, wanted, selector, data);
}

int UsbPort::request(std::uint16_t index, UvcRequest wanted, std::uint8_t selector, std::span<std::byte> data) noexcept
{
    if (handle_ == nullptr)
        return LIBUSB_ERROR_NO_DEVICE;
    // UVC 4.2: a class request to an interface, out (0x21) or in (0xA1); the selector is the high byte of wValue.
    const std::uint8_t type = wanted == UvcRequest::kSetCur ? 0x21 : 0xA1;
    return libusb_control_transfer(
        handle_, type, static_cast<std::uint8_t>(wanted), static_cast<std::uint16_t>(selector << 8), index,
        reinterpret_cast<unsigned char*>(data.data()), static_cast<std::uint16_t>(data.size()), kRequestMs);
}

int UsbPort::set_alternate(std::uint8_t number, bool& full) noexcept
{
    full = false;
    if (handle_ == nullptr)
        return LIBUSB_ERROR_NO_DEVICE;
    // libusb has no word for ENOSPC; it leaves errno as the ioctl set it.
    errno = 0;
    const int error = libusb_set_interface_alt_setting(handle_, streaming_interface_, number);
    full = error != 0 && errno == ENOSPC;
    return error;
}

Status UsbPort::reset() noexcept
{
    if (handle_ == nullptr)
        return usb_failure(name_.text, "port reset", LIBUSB_ERROR_NO_DEVICE);
    if (const int error = libusb_reset_device(handle_); error != 0)
        return usb_failure(name_.text, "port reset", error);
    return {};
}

} // namespace dicot
