#include "usb_session.h"

#include <algorithm>
#include <climits>
#include <cstring>
#include <mutex>

namespace dicot {
namespace {

constexpr std::size_t kStackBytes = std::size_t{256} * 1024;
constexpr timeval kNap{0, 200'000}; ///< how long the thread sleeps at most before it looks whether it is dismissed

} // namespace

Result<std::shared_ptr<UsbSession>> UsbSession::share()
{
    static std::mutex mutex;
    static std::weak_ptr<UsbSession> current;
    const std::lock_guard lock(mutex);
    if (std::shared_ptr<UsbSession> there = current.lock())
        return there;
    auto fresh = std::make_shared<UsbSession>();
    TRY(fresh->begin());
    current = fresh;
    return fresh;
}

Status UsbSession::begin() noexcept
{
    libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
    if (const int error = libusb_init(&context_); error != 0) {
        context_ = nullptr;
        return failure(Fault::kUnavailable, "libusb cannot be used (%s); are there device files under /dev/bus/usb?",
                       libusb_strerror(error));
    }
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes,
                              std::max<std::size_t>(kStackBytes, static_cast<std::size_t>(PTHREAD_STACK_MIN)));
    const int error = pthread_create(&thread_, &attributes, &serve, this);
    pthread_attr_destroy(&attributes);
    has_thread_ = error == 0;
    if (!has_thread_)
        return failure(Fault::kOsError, "the system gives no thread for the USB cameras (%s)", strerrordesc_np(error));
    return {};
}

UsbSession::~UsbSession()
{
    if (has_thread_) {
        dismissed_.store(true);
        libusb_interrupt_event_handler(context_);
        pthread_join(thread_, nullptr);
    }
    if (context_ != nullptr)
        libusb_exit(context_);
}

void* UsbSession::serve(void* session) noexcept
{
    UsbSession& self = *static_cast<UsbSession*>(session);
    while (!self.dismissed_.load()) {
        timeval nap = kNap;
        libusb_handle_events_timeout_completed(self.context_, &nap, nullptr);
    }
    return nullptr;
}

Status usb_failure(const char* port, const char* what, int error) noexcept
{
    switch (error) {
    case LIBUSB_ERROR_NO_DEVICE:
        return failure(Fault::kUnavailable, "the camera at USB port %s is gone (%s)", port, what);
    case LIBUSB_ERROR_ACCESS:
        return failure(
            Fault::kUnavailable,
            "the camera at USB port %s may not be opened (%s); give this user its device file by a udev rule", port,
            what);
    case LIBUSB_ERROR_BUSY:
        return failure(Fault::kUnavailable, "the camera at USB port %s is in use by another program (%s)", port, what);
    case LIBUSB_ERROR_NO_MEM:
        return failure(
            Fault::kTryAgain,
            "the camera at USB port %s: the kernel has no memory for transfers (%s); raise usbfs_memory_mb of "
            "the module usbcore, or use fewer slots",
            port, what);
    case LIBUSB_ERROR_PIPE:
        return failure(Fault::kTryAgain, "the camera at USB port %s refuses: %s", port, what);
    case LIBUSB_ERROR_TIMEOUT:
        return failure(Fault::kTryAgain, "the camera at USB port %s does not answer: %s", port, what);
    default:
        return failure(Fault::kTryAgain, "the camera at USB port %s: %s: %s", port, what, libusb_strerror(error));
    }
}

} // namespace dicot
