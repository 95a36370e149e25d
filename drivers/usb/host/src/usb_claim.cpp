#include "usb_claim.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace dicot::mtp {

UsbClaim::UsbClaim(UsbClaim&& other) noexcept
    : listed_(other.listed_), context_(std::exchange(other.context_, nullptr)),
      handle_(std::exchange(other.handle_, nullptr)), file_(std::exchange(other.file_, -1)),
      claimed_(std::exchange(other.claimed_, false))
{
}

UsbClaim::~UsbClaim()
{
    if (claimed_)
        libusb_release_interface(handle_, listed_.interface);
    if (handle_ != nullptr)
        libusb_close(handle_);
    if (context_ != nullptr)
        libusb_exit(context_);
    if (file_ >= 0)
        ::close(file_);
}

Result<UsbClaim> UsbClaim::take(const MtpListed& listed)
{
    UsbClaim claim(listed);
    TRY(claim.open());
    return claim;
}

Status UsbClaim::open()
{
    char path[64];
    std::snprintf(path, sizeof path, "/dev/bus/usb/%03d/%03d", listed_.bus, listed_.address);
    file_ = ::open(path, O_RDWR | O_CLOEXEC);
    if (file_ < 0) {
        const int error = errno;
        if (error == EACCES || error == EPERM)
            return failure_of(LIBUSB_ERROR_ACCESS, path);
        return failure(Fault::kUnavailable, "the device at USB port %s cannot be opened (%s: %s)", listed_.port.c_str(),
                       path, strerrordesc_np(error));
    }
    static std::mutex mutex; // the option is the process's
    {
        const std::lock_guard lock(mutex);
        libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
        if (const int error = libusb_init(&context_); error != 0) {
            context_ = nullptr;
            return failure(Fault::kUnavailable, "libusb cannot be used (%s)", libusb_strerror(error));
        }
    }
    if (const int error = libusb_wrap_sys_device(context_, file_, &handle_); error != 0) {
        handle_ = nullptr;
        return failure_of(error, "opening");
    }
    libusb_set_auto_detach_kernel_driver(handle_, 1);
    if (const int error = libusb_claim_interface(handle_, listed_.interface); error != 0)
        return failure_of(error, "claiming its interface");
    claimed_ = true;
    if (listed_.alternate != 0)
        if (const int error = libusb_set_interface_alt_setting(handle_, listed_.interface, listed_.alternate);
            error != 0)
            return failure_of(error, "choosing its setting");
    return {};
}

Status UsbClaim::failure_of(int error, const char* what) const noexcept
{
    const char* const port = listed_.port.c_str();
    switch (error) {
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
        return failure(Fault::kUnavailable, "the device at USB port %s is gone (%s)", port, what);
    case LIBUSB_ERROR_ACCESS:
        return failure(Fault::kUnavailable,
                       "the device at USB port %s may not be opened by this user (%s); install the package, or copy "
                       "61-dicot-computer.rules (toolchain/package/ of the sources) to /etc/udev/rules.d, and plug it "
                       "in again",
                       port, what);
    case LIBUSB_ERROR_BUSY:
        return failure(
            Fault::kUnavailable,
            "the device at USB port %s is in use by another program, mostly the file manager; close it there "
            "('gio mount -u mtp://...' lets go of it too), and try again",
            port);
    case LIBUSB_ERROR_NO_MEM:
        return failure(
            Fault::kOsError,
            "the device at USB port %s: the kernel has no memory for transfers; raise usbfs_memory_mb of the "
            "module usbcore, or pull from fewer devices at once",
            port);
    case LIBUSB_ERROR_TIMEOUT:
        return failure(Fault::kTryAgain, "the device at USB port %s does not answer", port);
    case LIBUSB_ERROR_PIPE:
        return failure(Fault::kIoError, "the device at USB port %s refuses %s", port, what);
    case LIBUSB_ERROR_OVERFLOW:
        return failure(Fault::kIoError, "the device at USB port %s sends more than was asked for", port);
    default:
        return failure(Fault::kIoError, "the device at USB port %s: %s: %s", port, what, libusb_strerror(error));
    }
}

} // namespace dicot::mtp
