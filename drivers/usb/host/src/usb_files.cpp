#include "usb_files.h"

#include <algorithm>
#include <charconv>
#include <climits>
#include <cstdio>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

namespace dicot::mtp {
namespace {

constexpr std::size_t kMostDevices = 512;

bool names_a_port(std::string_view name)
{
    return !name.empty() && name.size() <= 31 && name.front() >= '0' && name.front() <= '9' &&
           name.find('-') != std::string_view::npos && name.find(':') == std::string_view::npos;
}

} // namespace

std::span<const std::byte> usb_bytes(const char* folder, std::string_view device, const char* name,
                                     std::span<std::byte> room)
{
    char path[PATH_MAX];
    std::snprintf(path, sizeof path, "%s/%.*s/%s", folder, static_cast<int>(device.size()), device.data(), name);
    const int file = ::open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return {};
    std::size_t held = 0;
    while (held < room.size()) {
        const ssize_t got = ::read(file, room.data() + held, room.size() - held);
        if (got <= 0)
            break;
        held += static_cast<std::size_t>(got);
    }
    ::close(file);
    return room.first(held);
}

std::string usb_line(const char* folder, std::string_view device, const char* name)
{
    std::array<char, 512> room;
    const auto bytes = usb_bytes(folder, device, name, std::as_writable_bytes(std::span{room}));
    const std::string_view text{room.data(), bytes.size()};
    return std::string{text.substr(0, text.find('\n'))};
}

int usb_number(const char* folder, std::string_view device, const char* name)
{
    const std::string text = usb_line(folder, device, name);
    int number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

bool usb_ports(const char* folder, std::vector<std::string>& into)
{
    into.clear();
    DIR* const directory = ::opendir(folder);
    if (directory == nullptr)
        return false;
    while (const dirent* entry = ::readdir(directory)) // NOLINT(concurrency-mt-unsafe)
        if (names_a_port(entry->d_name) && into.size() < kMostDevices)
            into.emplace_back(entry->d_name);
    ::closedir(directory);
    std::ranges::sort(into);
    return true;
}

} // namespace dicot::mtp
