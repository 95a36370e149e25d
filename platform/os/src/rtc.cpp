#include "dicot/os/rtc.h"

#include "dicot/os/shown_path.h"
#include "dicot/os/small_file.h"

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <linux/rtc.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace dicot {
namespace {

/// The device for one call.
class OpenDevice
{
public:
    explicit OpenDevice(const char* path) noexcept
        : descriptor_(::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY))
    {
        if (descriptor_ < 0)
            error_ = errno;
    }
    OpenDevice(const OpenDevice&) = delete;
    OpenDevice& operator=(const OpenDevice&) = delete;
    ~OpenDevice()
    {
        if (descriptor_ >= 0)
            ::close(descriptor_);
    }

    /// 0, or the errno.
    int ask(unsigned long request, void* words) noexcept
    {
        if (descriptor_ >= 0)
            error_ = ::ioctl(descriptor_, request, words) == 0 ? 0 : errno;
        return error_;
    }

private:
    int descriptor_;
    int error_ = 0;
};

std::int64_t seconds_of(const rtc_time& time) noexcept
{
    const std::chrono::year_month_day day{std::chrono::year{time.tm_year + 1900},
                                          std::chrono::month{static_cast<unsigned>(time.tm_mon) + 1},
                                          std::chrono::day{static_cast<unsigned>(time.tm_mday)}};
    const std::int64_t days = std::chrono::sys_days{day}.time_since_epoch().count();
    return ((days * 24 + time.tm_hour) * 60 + time.tm_min) * 60 + time.tm_sec;
}

rtc_time time_of(std::int64_t seconds) noexcept
{
    const std::chrono::sys_seconds moment{std::chrono::seconds{seconds}};
    const auto day = std::chrono::floor<std::chrono::days>(moment);
    const std::chrono::year_month_day date{day};
    const std::chrono::hh_mm_ss hours{moment - day};
    rtc_time time{};
    time.tm_year = static_cast<int>(date.year()) - 1900;
    time.tm_mon = static_cast<int>(static_cast<unsigned>(date.month())) - 1;
    time.tm_mday = static_cast<int>(static_cast<unsigned>(date.day()));
    time.tm_hour = static_cast<int>(hours.hours().count());
    time.tm_min = static_cast<int>(hours.minutes().count());
    time.tm_sec = static_cast<int>(hours.seconds().count());
    return time;
}

/// A file of the clock below class/rtc; /dev/rtc is a link to the one that is meant.
JoinedPath attribute(const char* sys, const char* device, const char* name) noexcept
{
    char target[128];
    const ssize_t length = ::readlink(device, target, sizeof target - 1);
    const char* real = device;
    if (length > 0) {
        target[length] = '\0';
        real = target;
    }
    const char* slash = std::strrchr(real, '/');
    return JoinedPath{"%s/class/rtc/%s/%s", sys, slash == nullptr ? real : slash + 1, name};
}

std::optional<std::int64_t> number_in(const char* path) noexcept
{
    const auto line = read_line(path);
    std::int64_t number = 0;
    if (!line ||
        std::from_chars(line->view().data(), line->view().data() + line->view().size(), number).ec != std::errc{})
        return std::nullopt;
    return number;
}

Status refused(const char* device, const char* what, int error) noexcept
{
    const char* shown = shown_path(device);
    switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
        return failure(Fault::kUnavailable,
                       "%s: the board has no such clock; name its clock in power.rtc, or set power.between to \"idle\"",
                       shown);
    case EACCES:
    case EPERM:
    case EROFS:
        return failure(Fault::kUnavailable, "%s: no permission to %s; give the clock to the group dicot (udev)", shown,
                       what);
    case EBUSY:
        return failure(Fault::kUnavailable, "%s: another program has it, to %s; stop that one", shown, what);
    default:
        return failure(Fault::kUnavailable,
                       "%s: this clock does not let anybody %s (%s); set power.between to \"idle\"", shown, what,
                       strerrordesc_np(error));
    }
}

} // namespace

Result<std::int64_t> Rtc::now_s() const noexcept
{
    rtc_time time{};
    const int error = OpenDevice{device_.c_str()}.ask(RTC_RD_TIME, &time);
    if (error == 0)
        return seconds_of(time);
    if (const auto seconds = number_in(attribute(sys_.c_str(), device_.c_str(), "since_epoch").c_str()))
        return *seconds;
    return refused(device_.c_str(), "read its time", error);
}

Status Rtc::wake_after(std::int64_t after_s) noexcept
{
    rtc_wkalrm alarm{};
    OpenDevice device{device_.c_str()};
    int error = device.ask(RTC_RD_TIME, &alarm.time);
    if (error == 0) {
        alarm.time = time_of(seconds_of(alarm.time) + after_s);
        alarm.enabled = 1;
        error = device.ask(RTC_WKALM_SET, &alarm);
    }
    if (error == 0)
        return {};
    const JoinedPath wake = attribute(sys_.c_str(), device_.c_str(), "wakealarm");
    char words[32];
    std::snprintf(words, sizeof words, "+%lld", static_cast<long long>(after_s));
    (void)write_line(wake.c_str(), "0"); // an alarm that is set is not replaced: EBUSY
    const int by_file = write_line(wake.c_str(), words);
    if (by_file == 0)
        return {};
    return refused(device_.c_str(), "set its alarm", error == ENOENT || by_file == ENOENT ? error : by_file);
}

Status Rtc::no_alarm() noexcept
{
    rtc_wkalrm alarm{};
    OpenDevice device{device_.c_str()};
    int error = device.ask(RTC_WKALM_RD, &alarm);
    if (error == 0) {
        if (alarm.enabled == 0)
            return {};
        error = device.ask(RTC_RD_TIME, &alarm.time); // a valid time is wanted, though it will not ring
        alarm.enabled = 0;
        error = error == 0 ? device.ask(RTC_WKALM_SET, &alarm) : error;
    }
    if (error == 0 || write_line(attribute(sys_.c_str(), device_.c_str(), "wakealarm").c_str(), "0") == 0)
        return {};
    return refused(device_.c_str(), "clear its alarm", error);
}

Result<std::optional<std::int64_t>> Rtc::alarm_s() const noexcept
{
    rtc_wkalrm alarm{};
    const int error = OpenDevice{device_.c_str()}.ask(RTC_WKALM_RD, &alarm);
    if (error == 0)
        return alarm.enabled != 0 ? std::optional{seconds_of(alarm.time)} : std::nullopt;
    const JoinedPath wake = attribute(sys_.c_str(), device_.c_str(), "wakealarm");
    if (!read_line(wake.c_str()))
        return refused(device_.c_str(), "read its alarm", error);
    return number_in(wake.c_str());
}

} // namespace dicot
