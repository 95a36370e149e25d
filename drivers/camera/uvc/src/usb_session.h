// libusb, once a process: one context and one thread that handles the events of all cameras.
#pragma once

#include "dicot/base/status.h"

#include <libusb.h>

#include <atomic>
#include <memory>

#include <pthread.h>

namespace dicot {

/// Made by the first camera, gone with the last. libusb is told to discover no devices: cameras are found in sysfs and
/// opened by their device file, so a board without udev, and a camera that was plugged in again, work alike.
class UsbSession
{
public:
    /// Fault::kUnavailable: the system has no USB device files. Fault::kOsError: no thread.
    static Result<std::shared_ptr<UsbSession>> share();

    UsbSession() = default;
    UsbSession(const UsbSession&) = delete;
    UsbSession& operator=(const UsbSession&) = delete;
    ~UsbSession();

    libusb_context* context() const noexcept { return context_; }

private:
    Status begin() noexcept;
    static void* serve(void* session) noexcept;

    libusb_context* context_ = nullptr;
    pthread_t thread_{};
    bool has_thread_ = false;
    std::atomic<bool> dismissed_{false};
};

/// The sentence and the fault of a libusb error; `what` says what was tried: "the camera at USB port 1-1: claim".
/// LIBUSB_ERROR_NO_DEVICE is Fault::kUnavailable; timeouts, stalls and interruptions Fault::kTryAgain.
Status usb_failure(const char* port, const char* what, int error) noexcept;

} // namespace dicot
