#include "device.h"
#include "dicot/os/clock.h"
#include "dicot/v4l2/v4l2_camera.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <unistd.h>

namespace dicot {
namespace {

constexpr std::int64_t kComebackUs = 3'000'000;
constexpr long kPauseNs = 50'000'000;

} // namespace

/// The same model at the same place, as soon as it is there.
Status V4l2Camera::find_again() noexcept
{
    const CameraIdentity before = node_.identity;
    const std::int64_t until_us = monotonic_us() + kComebackUs;
    for (;;) {
        const Status status = open(before.port.text);
        if (status.ok()) {
            const CameraIdentity now = node_.identity;
            if (now.vendor == before.vendor && now.product == before.product)
                return {};
            close();
            node_.identity = before;
            return failure(Fault::kUnavailable,
                           "camera %s: %04x:%04x is plugged in where %04x:%04x was; plug the camera in again",
                           before.port.text, now.vendor, now.product, before.vendor, before.product);
        }
        if (monotonic_us() > until_us)
            return status;
        const timespec pause{0, kPauseNs};
        ::nanosleep(&pause, nullptr);
    }
}

Status V4l2Camera::reset_port() noexcept
{
    const char* port = node_.identity.port.text;
    if (!v4l2::is_port(port))
        return failure(Fault::kUnavailable, "camera %s: is not on USB, there is no port to reset; restart the device",
                       port);
    const int bus = v4l2::read_number(v4l2::UsbAttribute{port, "busnum"}.path, -1);
    const int device = v4l2::read_number(v4l2::UsbAttribute{port, "devnum"}.path, -1);
    if (bus < 0 || device < 0)
        return failed("looking for its port", ENODEV);
    char path[40];
    std::snprintf(path, sizeof path, "/dev/bus/usb/%03d/%03d", bus, device);
    const int descriptor = v4l2::open_without_wait(path, O_WRONLY);
    if (descriptor < 0)
        return failure(Fault::kUnavailable,
                       "camera %s: its port cannot be reset (%s: %s); allow this user to write there", port, path,
                       strerrordesc_np(errno));
    const int error = v4l2::call(descriptor, USBDEVFS_RESET, nullptr);
    ::close(descriptor);
    // ENODEV: the device came back as another one, and is to be found again.
    return error == 0 || error == ENODEV ? Status{} : failed("resetting its port", error);
}

Status V4l2Camera::shake(Shake how)
{
    if (node_.identity.port.text[0] == '\0')
        return failed("shaking", ENODEV);
    const bool streamed = streaming_ || resume_;
    const CameraMode mode = mode_;
    TRY(stop());
    if (how != Shake::kRestart || descriptor_ < 0) {
        close();
        resume_ = streamed; // a failure below must not make the next shake forget it
        if (how == Shake::kPort)
            TRY(reset_port());
        TRY(find_again());
    }
    resume_ = streamed;
    if (streamed)
        TRY(start(mode));
    resume_ = false;
    return {};
}

} // namespace dicot
