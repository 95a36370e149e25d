// Calls of the kernel that a signal does not cut short, and what sysfs tells of a device. No heap.
#pragma once

#include "dicot/camera/camera.h"

#include <cstddef>
#include <span>

#include <linux/videodev2.h>

namespace dicot::v4l2 {

/// 0, or errno.
int call(int descriptor, unsigned long request, void* argument) noexcept;
template <typename T>
int call(int descriptor, unsigned long request, T& argument) noexcept
{
    return call(descriptor, request, static_cast<void*>(&argument));
}

/// Opens without waiting; -1 and errno.
int open_without_wait(const char* path, int flags) noexcept;

/// Reads at most into.size() bytes of a small file of sysfs; returns how many, 0 if it is not there.
std::size_t read_small(const char* path, std::span<std::byte> into) noexcept;
/// One line of text, cut to the room; empty if it is not there.
void read_line(const char* path, std::span<char> line) noexcept;
/// A decimal number of sysfs, or `otherwise`.
int read_number(const char* path, int otherwise) noexcept;

/// "1-1.2" of ".../1-1.2:1.0", where an interface of a USB device ends in that way; empty of anything else.
std::span<const char> port_in(const char* device_path) noexcept;
/// Whether it may stand in a path of sysfs: digits, '-' and '.', such as "1-1.2".
bool is_port(const char* text) noexcept;

/// The path of what sysfs tells of the USB device at a port, for which is_port() holds.
struct UsbAttribute
{
    UsbAttribute(const char* port, const char* name) noexcept;
    char path[96];
};

/// True: the node takes pictures by streaming, and `identity` is filled.
bool identify(int descriptor, CameraIdentity& identity) noexcept;

} // namespace dicot::v4l2
