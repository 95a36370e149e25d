// A device file, its libusb handle and its claimed interface.
#pragma once

#include "dicot/base/status.h"
#include "dicot/mtp_host/mtp_list.h"

#include <libusb.h>

namespace dicot::mtp {

/// Of one device, with a libusb of its own: devices on several threads do not wait for each other.
class UsbClaim
{
public:
    static Result<UsbClaim> take(const MtpListed& listed);

    UsbClaim(UsbClaim&& other) noexcept;
    UsbClaim& operator=(UsbClaim&&) = delete;
    ~UsbClaim();

    const MtpListed& listed() const noexcept { return listed_; }
    libusb_context* context() const noexcept { return context_; }
    libusb_device_handle* handle() const noexcept { return handle_; }

    /// The sentence and the fault of a libusb error; `what` was tried.
    Status failure_of(int error, const char* what) const noexcept;

private:
    explicit UsbClaim(const MtpListed& listed) noexcept : listed_(listed) {}
    Status open();

    MtpListed listed_;
    libusb_context* context_ = nullptr;
    libusb_device_handle* handle_ = nullptr;
    int file_ = -1;
    bool claimed_ = false;
};

} // namespace dicot::mtp
