// What the kernel tells of its USB devices in files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dicot::mtp {

/// "FOLDER/DEVICE/NAME": as much of it as `room` holds; 0 bytes if it is not there.
std::span<const std::byte> usb_bytes(const char* folder, std::string_view device, const char* name,
                                     std::span<std::byte> room);
/// Its first line; a number, 0 if it is none.
std::string usb_line(const char* folder, std::string_view device, const char* name);
int usb_number(const char* folder, std::string_view device, const char* name);

/// Devices at ports ("1-1.4"), no root hubs and no interfaces, in order. False: there is no such folder.
bool usb_ports(const char* folder, std::vector<std::string>& into);

} // namespace dicot::mtp
