#include "dicot/os/hardware_watchdog.h"

#include "dicot/os/shown_path.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <linux/watchdog.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace dicot {
namespace {

Status cannot_open(const char* device, int error) noexcept
{
    const char* shown = shown_path(device);
    switch (error) {
    case ENOENT:
    case ENODEV:
        return failure(Fault::kUnavailable, "%s: the board has no such watchdog; set watchdog.device to \"\"", shown);
    case EACCES:
    case EPERM:
        return failure(Fault::kUnavailable, "%s: no permission to open the watchdog; give it to the group dicot",
                       shown);
    case EBUSY:
        return failure(Fault::kUnavailable,
                       "%s: another program has the watchdog (systemd, if RuntimeWatchdogSec is set); set "
                       "watchdog.device to \"\"",
                       shown);
    default:
        return failure(Fault::kUnavailable, "%s: the watchdog cannot be opened (%s); set watchdog.device to \"\"",
                       shown, strerrordesc_np(error));
    }
}

} // namespace

HardwareWatchdog::~HardwareWatchdog()
{
    let_go();
}

Status HardwareWatchdog::open(const char* device, int timeout_s) noexcept
{
    let_go();
    descriptor_ = ::open(device, O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (descriptor_ < 0)
        return cannot_open(device, errno);
    watchdog_info identity{};
    if (::ioctl(descriptor_, WDIOC_GETSUPPORT, &identity) != 0) {
        ::close(descriptor_); // nothing is written to what is no watchdog
        descriptor_ = -1;
        return failure(Fault::kConfig, "%s: is no watchdog; set watchdog.device to \"/dev/watchdog\" or \"\"",
                       shown_path(device));
    }
    int seconds = timeout_s;
    const bool told =
        ::ioctl(descriptor_, WDIOC_SETTIMEOUT, &seconds) == 0 || ::ioctl(descriptor_, WDIOC_GETTIMEOUT, &seconds) == 0;
    if (told && seconds >= timeout_s)
        return {};
    let_go();
    return failure(Fault::kConfig,
                   "%s: the watchdog bites after %d s, and a stage may be silent for %d s; set watchdog.device to \"\" "
                   "and let systemd hold it (RuntimeWatchdogSec)",
                   shown_path(device), told ? seconds : 0, timeout_s);
}

void HardwareWatchdog::kick() noexcept
{
    if (descriptor_ >= 0)
        (void)::ioctl(descriptor_, WDIOC_KEEPALIVE, 0);
}

void HardwareWatchdog::let_go() noexcept
{
    if (descriptor_ < 0)
        return;
    (void)!::write(descriptor_, "V", 1);
    ::close(descriptor_);
    descriptor_ = -1;
}

} // namespace dicot
