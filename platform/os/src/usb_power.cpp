#include "dicot/os/usb_power.h"

#include "dicot/os/small_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string_view>

#include <unistd.h>

namespace dicot {
namespace {

/// "1-1.2": numbers with '-' after the first and '.' after the others.
bool is_port(std::string_view text) noexcept
{
    if (text.size() > 31 || text.find('-') == std::string_view::npos)
        return false;
    char joint = '-';
    while (true) {
        const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
        if (digits == 0 || digits > 3)
            return false;
        if (digits == text.size())
            return joint == '.';
        if (text[digits] != joint)
            return false;
        joint = '.';
        text.remove_prefix(digits + 1);
    }
}

Status refused(const char* port, const char* what, int error) noexcept
{
    if (error == ENOENT || error == ENODEV)
        return failure(Fault::kUnavailable, "USB port %s: no device is there to %s", port, what);
    if (error == EACCES || error == EPERM || error == EROFS)
        return failure(Fault::kUnavailable, "USB port %s: no permission to %s; the udev rule of the package gives it",
                       port, what);
    return failure(Fault::kUnavailable, "USB port %s: the kernel does not %s (%s)", port, what, strerrordesc_np(error));
}

} // namespace

Result<UsbPower> UsbPower::at(const char* port, const char* sys) noexcept
{
    const std::string_view name{port};
    if (!is_port(name))
        return failure(Fault::kConfig, "\"%.40s\" is no USB port; dicot probe lists them, as 1-1.2", port);
    UsbPower power;
    power.port_ = name;
    power.sys_ = sys;
    const std::size_t joint = name.find_last_of(".-");
    const std::string_view hub = name.substr(0, joint);
    std::from_chars(port + joint + 1, port + name.size(), power.number_);
    char words[40];
    const bool root = name[joint] == '-';
    std::snprintf(words, sizeof words, root ? "usb%.*s" : "%.*s", static_cast<int>(hub.size()), hub.data());
    power.hub_ = words;
    std::snprintf(words, sizeof words, root ? "%.*s-0:1.0" : "%.*s:1.0", static_cast<int>(hub.size()), hub.data());
    power.interface_ = words;
    return power;
}

bool UsbPower::present() const noexcept
{
    const auto line =
        read_line(JoinedPath{"%s/bus/usb/devices/%s/bConfigurationValue", sys_.c_str(), port_.c_str()}.c_str());
    return line && !line->empty();
}

Status UsbPower::let_sleep(int delay_ms) noexcept
{
    const JoinedPath delay{"%s/bus/usb/devices/%s/power/autosuspend_delay_ms", sys_.c_str(), port_.c_str()};
    const JoinedPath control{"%s/bus/usb/devices/%s/power/control", sys_.c_str(), port_.c_str()};
    char words[16];
    std::snprintf(words, sizeof words, "%d", delay_ms);
    (void)write_line(delay.c_str(), words); // the kernel's own, 2 s, does as well
    if (const auto now = read_line(control.c_str()); now && now->view() == "auto")
        return {};
    const int error = write_line(control.c_str(), "auto");
    return error == 0 ? Status{} : refused(port_.c_str(), "let it sleep", error);
}

Status UsbPower::keep_on() noexcept
{
    const JoinedPath control{"%s/bus/usb/devices/%s/power/control", sys_.c_str(), port_.c_str()};
    if (const auto now = read_line(control.c_str()); now && now->view() == "on")
        return {};
    const int error = write_line(control.c_str(), "on");
    return error == 0 ? Status{} : refused(port_.c_str(), "keep it on", error);
}

Result<bool> UsbPower::sleeps() const noexcept
{
    const auto line =
        read_line(JoinedPath{"%s/bus/usb/devices/%s/power/runtime_status", sys_.c_str(), port_.c_str()}.c_str());
    if (!line)
        return refused(port_.c_str(), "ask whether it sleeps", ENOENT);
    return line->view() == "suspended";
}

JoinedPath UsbPower::disable_path(bool of_twin) const noexcept
{
    return JoinedPath{"%s/bus/usb/devices/%s/%s-port%d/%sdisable",
                      sys_.c_str(),
                      interface_.c_str(),
                      hub_.c_str(),
                      number_,
                      of_twin ? "peer/" : ""};
}

Status UsbPower::can_switch() const noexcept
{
    const JoinedPath path = disable_path(false);
    if (::access(path.c_str(), F_OK) != 0)
        return failure(Fault::kUnavailable,
                       "USB port %s: its hub %s takes no orders for single ports, or the kernel is older than 6.0; set "
                       "power.cameras to \"auto\"",
                       port_.c_str(), hub_.c_str());
    return ::access(path.c_str(), W_OK) == 0 ? Status{} : refused(port_.c_str(), "switch it", errno);
}

Status UsbPower::set_disable(const char* value) noexcept
{
    TRY(can_switch());
    if (::access(disable_path(true).c_str(), F_OK) == 0)
        (void)write_line(disable_path(true).c_str(), value);
    const int error = write_line(disable_path(false).c_str(), value);
    return error == 0 ? Status{} : refused(port_.c_str(), "switch it", error);
}

Status UsbPower::off() noexcept
{
    return set_disable("1");
}

Status UsbPower::on() noexcept
{
    return set_disable("0");
}

Status wait_for_device(const char* port, int wait_ms, const char* sys) noexcept
{
    constexpr int kLookMs = 50;
    const UsbPower power = TRY(UsbPower::at(port, sys));
    for (int waited_ms = 0;; waited_ms += kLookMs) {
        if (power.present())
            return {};
        if (waited_ms >= wait_ms)
            return failure(Fault::kTryAgain, "USB port %s: no camera appeared within %d ms; check its cable", port,
                           wait_ms);
        const timespec pause{0, kLookMs * 1'000'000L};
        (void)::nanosleep(&pause, nullptr);
    }
}

} // namespace dicot
