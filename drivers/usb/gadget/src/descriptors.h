// What FunctionFS is told of our interface: descriptors for each speed, and the string that names it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot::gadget_parts {

/// Bytes for FunctionFS's ep0. Source: Linux, include/uapi/linux/usb/functionfs.h; USB Still Image Capture Device
/// Definition 1.0, 4 (class 6, subclass 1, protocol 1, three endpoints); Microsoft OS Descriptors 1.0 ("MTP").
class DescriptorBlock
{
public:
    /// `os_version`: of the OS descriptors' header. 0x0100 is the standard's; kernels before 6.0 take 0x0001 alone.
    explicit DescriptorBlock(std::uint16_t os_version) noexcept;
    std::span<const std::byte> bytes() const noexcept { return std::span(bytes_).first(size_); }

private:
    void put8(unsigned value) noexcept;
    void put16(unsigned value) noexcept;
    void put32(std::uint32_t value) noexcept;
    void interface() noexcept;
    void endpoint(unsigned address, unsigned type, unsigned packet, unsigned interval) noexcept;
    void companion(unsigned burst, unsigned bytes_per_interval) noexcept;

    std::array<std::byte, 256> bytes_{};
    std::size_t size_ = 0;
};

/// Likewise: "MTP", by which libmtp and others know a device that they have no entry for. English.
std::span<const std::byte> interface_string() noexcept;

inline constexpr unsigned kBulkInAddress = 0x81, kBulkOutAddress = 0x02, kEventsAddress = 0x83;
inline constexpr unsigned kEventPacket = 28;

} // namespace dicot::gadget_parts
