#include "device.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace dicot::v4l2 {
namespace {

bool digit(char c) noexcept
{
    return c >= '0' && c <= '9';
}

std::uint16_t read_hex(const char* path) noexcept
{
    char line[16];
    read_line(path, line);
    return static_cast<std::uint16_t>(std::strtoul(line, nullptr, 16));
}

/// The folder of sysfs of the device behind an open node; empty if there is none.
void device_folder(int descriptor, std::span<char, PATH_MAX> folder) noexcept
{
    folder[0] = '\0';
    struct stat what
    {
    };
    if (::fstat(descriptor, &what) != 0 || !S_ISCHR(what.st_mode))
        return;
    char link[64];
    std::snprintf(link, sizeof link, "/sys/dev/char/%u:%u/device", major(what.st_rdev), minor(what.st_rdev));
    if (::realpath(link, folder.data()) == nullptr)
        folder[0] = '\0';
}

template <std::size_t N>
void assign_line(DeviceText<N>& text, const char* path) noexcept
{
    char line[N + 1];
    read_line(path, line);
    text.assign(line, std::strlen(line));
}

} // namespace

UsbAttribute::UsbAttribute(const char* port, const char* name) noexcept
{
    std::snprintf(path, sizeof path, "/sys/bus/usb/devices/%s/%s", port, name);
}

int call(int descriptor, unsigned long request, void* argument) noexcept
{
    while (::ioctl(descriptor, request, argument) != 0)
        if (errno != EINTR)
            return errno;
    return 0;
}

int open_without_wait(const char* path, int flags) noexcept
{
    int descriptor = -1;
    do
        descriptor = ::open(path, flags | O_NONBLOCK | O_CLOEXEC);
    while (descriptor < 0 && errno == EINTR);
    return descriptor;
}

std::size_t read_small(const char* path, std::span<std::byte> into) noexcept
{
    const int descriptor = open_without_wait(path, O_RDONLY);
    if (descriptor < 0)
        return 0;
    std::size_t filled = 0;
    while (filled < into.size()) {
        const ssize_t got = ::read(descriptor, into.data() + filled, into.size() - filled);
        if (got > 0)
            filled += static_cast<std::size_t>(got);
        else if (got == 0 || errno != EINTR)
            break;
    }
    ::close(descriptor);
    return filled;
}

void read_line(const char* path, std::span<char> line) noexcept
{
    const std::size_t got = read_small(path, std::as_writable_bytes(line.first(line.size() - 1)));
    line[got] = '\0';
    line[std::strcspn(line.data(), "\n")] = '\0';
}

int read_number(const char* path, int otherwise) noexcept
{
    char line[16];
    read_line(path, line);
    return digit(line[0]) ? static_cast<int>(std::strtol(line, nullptr, 10)) : otherwise;
}

bool is_port(const char* text) noexcept
{
    const std::size_t length = std::strlen(text);
    return length >= 3 && length <= 31 && digit(text[0]) && digit(text[length - 1]) &&
           std::strspn(text, "0123456789-.") == length && std::strchr(text, '-') != nullptr &&
           std::strstr(text, "..") == nullptr;
}

std::span<const char> port_in(const char* device_path) noexcept
{
    const char* slash = std::strrchr(device_path, '/');
    const char* name = slash == nullptr ? device_path : slash + 1;
    const char* colon = std::strchr(name, ':');
    if (colon == nullptr || !digit(name[0]) || !digit(colon[1]))
        return {};
    const std::span<const char> port{name, colon};
    char text[32];
    if (port.size() >= sizeof text)
        return {};
    *std::ranges::copy(port, text).out = '\0';
    return is_port(text) ? port : std::span<const char>{};
}

bool identify(int descriptor, CameraIdentity& identity) noexcept
{
    v4l2_capability told{};
    if (call(descriptor, VIDIOC_QUERYCAP, told) != 0)
        return false;
    const std::uint32_t able = (told.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? told.device_caps : told.capabilities;
    constexpr std::uint32_t kNeeded = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
    if ((able & kNeeded) != kNeeded)
        return false;

    identity = {};
    identity.driver = "v4l2";
    const auto text_of = [](const __u8* text) { return static_cast<const char*>(static_cast<const void*>(text)); };
    identity.name.assign(text_of(told.card), sizeof told.card);
    identity.port.assign(text_of(told.bus_info), sizeof told.bus_info);
    char folder[PATH_MAX];
    device_folder(descriptor, folder);
    const std::span<const char> port = port_in(folder);
    if (port.empty())
        return true;
    identity.port.assign(port.data(), port.size());
    identity.vendor = read_hex(UsbAttribute{identity.port.text, "idVendor"}.path);
    identity.product = read_hex(UsbAttribute{identity.port.text, "idProduct"}.path);
    assign_line(identity.serial, UsbAttribute{identity.port.text, "serial"}.path);
    DeviceText<63> product;
    assign_line(product, UsbAttribute{identity.port.text, "product"}.path);
    if (product.text[0] != '\0')
        identity.name = product;
    return true;
}

} // namespace dicot::v4l2
