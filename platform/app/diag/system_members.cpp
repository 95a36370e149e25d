#include "diag_members.h"

#include "../store/slot_words.h"

#include "dicot/os/host.h"

#include <nlohmann/json.hpp>

#include <sys/timex.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

namespace dicot::app {
namespace {

namespace fs = std::filesystem;

Result<std::string> whole_file(const std::string& path)
{
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (descriptor < 0)
        return failure(Fault::kNoInput, "%s: %s", path.c_str(), std::strerror(errno));
    std::string text;
    char part[4096];
    ::ssize_t got = 0;
    while (text.size() < DiagMembers::kMostFile && (got = ::read(descriptor, part, sizeof part)) > 0)
        text.append(part, static_cast<std::size_t>(got));
    const int error = errno;
    (void)::close(descriptor);
    if (got < 0)
        return failure(Fault::kIoError, "%s: %s", path.c_str(), std::strerror(error));
    return text;
}

std::string line_of(const fs::path& path)
{
    Result<std::string> text = whole_file(path.string());
    return text.ok() ? std::move(text).value().substr(0, text.value().find('\n')) : std::string{};
}

/// A line an interface of sysfs: what it is called, and what it says of speed and power.
std::string usb_devices()
{
    std::vector<fs::path> devices;
    std::error_code error;
    for (fs::directory_iterator entry("/sys/bus/usb/devices", error); !error && entry != fs::directory_iterator{};
         entry.increment(error))
        if (fs::exists(entry->path() / "idVendor", error))
            devices.push_back(entry->path());
    std::ranges::sort(devices);
    std::string text;
    for (const fs::path& device : devices) {
        text += device.filename().string();
        for (const char* name : {"idVendor", "idProduct", "manufacturer", "product", "speed", "bMaxPower", "version",
                                 "power/control", "power/runtime_status", "power/autosuspend_delay_ms"})
            text += "\t" + std::string(name) + "=" + line_of(device / name);
        text += "\n";
    }
    return text;
}

std::string clock_text()
{
    ::timex now{};
    const int state = ::adjtimex(&now);
    return json_text({{"state", state},
                      {"status", now.status},
                      {"unsynchronised", (now.status & STA_UNSYNC) != 0},
                      {"offset", now.offset},
                      {"frequency", now.freq},
                      {"max_error_us", now.maxerror},
                      {"estimated_error_us", now.esterror},
                      {"tai_s", now.tai},
                      {"seconds", now.time.tv_sec}}) +
           "\n";
}

/// What the service said lately, as journald kept it.
Result<std::string> service_log()
{
    FILE* const pipe = ::popen("journalctl --quiet --no-pager --output=short-iso --unit=dicot --lines=2000 2>&1", "r");
    if (pipe == nullptr)
        return failure(Fault::kOsError, "journalctl cannot be started: %s", std::strerror(errno));
    std::string text;
    char part[4096];
    while (const std::size_t got = std::fread(part, 1, sizeof part, pipe))
        if (text.size() < DiagMembers::kMostFile)
            text.append(part, got);
    if (::pclose(pipe) != 0 || text.empty())
        return failure(Fault::kUnavailable, "journald has no lines of dicot for this user (group systemd-journal): %s",
                       text.c_str());
    return text;
}

std::string system_name()
{
    ::utsname name{};
    (void)::uname(&name);
    return std::string(name.sysname) + " " + name.release + " " + name.version + " " + name.machine + "\n";
}

std::string temperatures_text()
{
    nlohmann::json all = nlohmann::json::object();
    for (const Temperature& one : read_temperatures())
        all[one.name] = one.celsius;
    return json_text(all) + "\n";
}

} // namespace

Status DiagMembers::put(const std::string& name, std::string_view text)
{
    ++made_;
    return archive_.add(folder_ + "/" + name, text);
}

Status DiagMembers::missing(const std::string& name, std::string_view why)
{
    ++not_made_;
    return archive_.add(folder_ + "/" + name + ".missing.txt", std::string(why) + "\n");
}

Status DiagMembers::put_file(const std::string& name, const std::string& path)
{
    const Result<std::string> text = whole_file(path);
    return text.ok() ? put(name, text.value()) : missing(name, text.status().message());
}

Status add_system(DiagMembers& members)
{
    for (const char* name : {"cpuinfo", "meminfo", "mounts", "cmdline", "uptime", "loadavg", "version"})
        TRY(members.put_file(std::string("system/") + name, std::string("/proc/") + name));
    TRY(members.put_file("system/limits", "/proc/self/limits"));
    TRY(members.put_file("system/status", "/proc/self/status"));
    TRY(members.put_file("system/os-release", "/etc/os-release"));
    TRY(members.put_file("system/power-states", "/sys/power/state"));
    TRY(members.put("system/uname", system_name()));
    TRY(members.put("system/clock.json", clock_text()));
    TRY(members.put("system/temperatures.json", temperatures_text()));
    const std::string usb = usb_devices();
    TRY(usb.empty() ? members.missing("system/usb", "the system lists no USB device") : members.put("system/usb", usb));
    const Result<std::string> log = service_log();
    TRY(log.ok() ? members.put("system/journal", log.value())
                 : members.missing("system/journal", log.status().message()));
    for (const char* unit : {"/lib/systemd/system/dicot.service", "/etc/systemd/system/dicot.service"})
        TRY(members.put_file(std::string("units") + unit, unit));
    return {};
}

} // namespace dicot::app
