#include "dicot/uvc/uvc_list.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <climits>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

namespace dicot {
namespace {

constexpr std::size_t kMostUsbDevices = 512;

/// A file of a device: "<folder>/<port>/<name>".
struct Attribute
{
    Attribute(const char* folder, const char* port, const char* name) noexcept
    {
        std::snprintf(path, sizeof path, "%s/%s/%s", folder, port, name);
    }
    char path[PATH_MAX];
};

/// As much of a small file as `room` holds; 0 if it is not there.
std::size_t read_whole(const Attribute& attribute, std::span<std::byte> room) noexcept
{
    const int file = ::open(attribute.path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return 0;
    std::size_t held = 0;
    while (held < room.size()) {
        const ssize_t got = ::read(file, room.data() + held, room.size() - held);
        if (got <= 0)
            break;
        held += static_cast<std::size_t>(got);
    }
    ::close(file);
    return held;
}

/// The first line of an attribute.
template <std::size_t N>
std::string_view line_of(const Attribute& attribute, std::array<char, N>& room) noexcept
{
    const std::size_t held = read_whole(attribute, std::as_writable_bytes(std::span{room}));
    const std::string_view text{room.data(), held};
    return text.substr(0, text.find('\n'));
}

int number_of(const Attribute& attribute) noexcept
{
    std::array<char, 32> room{};
    const std::string_view text = line_of(attribute, room);
    int number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

/// Linux tells Mbit/s: 1.5, 12, 480, 5000, 10000, 20000.
UsbSpeed speed_of(int mbit_per_s) noexcept
{
    if (mbit_per_s >= 5000)
        return UsbSpeed::kSuper;
    return mbit_per_s >= 480 ? UsbSpeed::kHigh : UsbSpeed::kFull;
}

/// "1-1.2" is a device at a port; "usb1" is a root hub and "1-1.2:1.0" an interface.
bool names_a_port(std::string_view name) noexcept
{
    return !name.empty() && name.front() >= '0' && name.front() <= '9' && name.find('-') != std::string_view::npos &&
           name.find(':') == std::string_view::npos && name.size() <= 31;
}

std::vector<std::string> ports_in(const char* folder, bool& there)
{
    std::vector<std::string> ports;
    DIR* directory = ::opendir(folder);
    there = directory != nullptr;
    if (!there)
        return ports;
    while (const dirent* entry = ::readdir(directory)) { // NOLINT(concurrency-mt-unsafe)
        if (names_a_port(entry->d_name) && ports.size() < kMostUsbDevices)
            ports.emplace_back(entry->d_name);
    }
    ::closedir(directory);
    std::ranges::sort(ports);
    return ports;
}

UvcListed listed_at(const char* folder, const char* port, std::span<const std::byte> descriptors) noexcept
{
    UvcListed listed;
    listed.identity.driver = "uvc";
    listed.identity.port.assign(port, std::strlen(port));
    std::array<char, 256> room{};
    const std::string_view name = line_of({folder, port, "product"}, room);
    listed.identity.name.assign(name.data(), name.size());
    const std::string_view serial = line_of({folder, port, "serial"}, room);
    listed.identity.serial.assign(serial.data(), serial.size());
    listed.bus = number_of({folder, port, "busnum"});
    listed.address = number_of({folder, port, "devnum"});
    listed.speed = speed_of(number_of({folder, port, "speed"}));

    const int configuration = number_of({folder, port, "bConfigurationValue"});
    const Result<UvcDevice> read = parse_uvc_device(descriptors, static_cast<std::uint8_t>(configuration));
    if (read.ok())
        listed.device = read.value();
    else
        listed.unusable = failure(read.status().fault(), "the camera at USB port %s cannot be used: %s", port,
                                  read.status().message());
    listed.identity.vendor = listed.device.vendor;
    listed.identity.product = listed.device.product;
    return listed;
}

/// Whether the kernel found an interface of the video class, whatever became of the rest.
bool has_video(std::span<const std::byte> descriptors) noexcept
{
    for (std::size_t at = 18; at + 9 <= descriptors.size();) {
        const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(descriptors[at + i]); };
        if (byte(1) == 4 && byte(5) == 0x0E)
            return true;
        at += std::max(byte(0), 1u);
    }
    return false;
}

} // namespace

Result<std::vector<UvcListed>> list_uvc_cameras(const char* folder)
{
    bool there = false;
    const std::vector<std::string> ports = ports_in(folder, there);
    if (!there)
        return failure(Fault::kUnavailable, "%s: this system lists no USB devices; is USB in its kernel?", folder);
    std::vector<std::byte> room(kMostUsbDescriptorBytes);
    std::vector<UvcListed> cameras;
    for (const std::string& port : ports) {
        const auto descriptors = std::span{room}.first(read_whole({folder, port.c_str(), "descriptors"}, room));
        if (has_video(descriptors))
            cameras.push_back(listed_at(folder, port.c_str(), descriptors));
    }
    return cameras;
}

Result<UvcListed> look_at_port(const char* port, std::span<std::byte> room, const char* folder) noexcept
{
    const auto descriptors = room.first(read_whole({folder, port, "descriptors"}, room));
    if (!names_a_port(port) || !has_video(descriptors))
        return failure(Fault::kUnavailable, "there is no camera at USB port %.31s", port);
    UvcListed listed = listed_at(folder, port, descriptors);
    if (!listed.unusable.ok())
        return listed.unusable;
    return listed;
}

Result<UvcListed> find_uvc_camera(std::string_view which, const char* folder)
{
    const std::vector<UvcListed> cameras = TRY(list_uvc_cameras(folder));
    const auto chosen = [](const UvcListed& camera) -> Result<UvcListed> {
        if (!camera.unusable.ok())
            return camera.unusable;
        return camera;
    };
    for (const UvcListed& camera : cameras)
        if (which == camera.identity.port.text)
            return chosen(camera);
    const auto has_serial = [&](const UvcListed& camera) {
        return !which.empty() && which == camera.identity.serial.text;
    };
    const auto same = std::ranges::count_if(cameras, has_serial);
    const int length = static_cast<int>(std::min<std::size_t>(which.size(), 64));
    if (same > 1)
        return failure(Fault::kUnavailable, "%d cameras have the serial number %.*s; name the USB port instead",
                       static_cast<int>(same), length, which.data());
    if (same == 1)
        return chosen(*std::ranges::find_if(cameras, has_serial));

    std::string there;
    for (const UvcListed& camera : cameras)
        there += std::string{there.empty() ? "" : ", "} + camera.identity.port.text;
    return failure(Fault::kUnavailable, "there is no camera at USB port or with serial number '%.*s'; there %s %s",
                   length, which.data(), cameras.size() == 1 ? "is one at" : "are",
                   there.empty() ? "none" : there.c_str());
}

} // namespace dicot
