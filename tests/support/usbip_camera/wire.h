// Messages of USB/IP as they travel between a device and the kernel's virtual host controller.
//
// Source: Documentation/usb/usbip_protocol.rst of the kernel. All numbers are big-endian; a message is 48 bytes, then
// the bytes of the transfer, then 16 bytes for each isochronous packet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace dicot::usbip {

using Bytes = std::vector<std::uint8_t>;

/// One isochronous packet of a transfer. Lengths and offsets in bytes.
struct IsoPacket
{
    std::uint32_t offset = 0;
    std::uint32_t length = 0;        ///< room that the host gave it
    std::uint32_t actual_length = 0; ///< what came
    int status = 0;                  ///< 0 or a negative errno
};

/// What the host asks for: one transfer on one endpoint, or the end of an earlier one.
struct Request
{
    enum class Kind
    {
        kSubmit,
        kUnlink,
    };
    Kind kind = Kind::kSubmit;
    std::uint32_t sequence = 0;
    std::uint32_t victim = 0; ///< kUnlink: the sequence of the transfer to end
    bool in = false;          ///< towards the host
    unsigned endpoint = 0;    ///< 0 .. 15
    std::uint32_t length = 0; ///< bytes that the host has room for, or sends
    std::uint32_t start_frame = 0;
    std::array<std::uint8_t, 8> setup{};
    Bytes out; ///< data towards the device
    std::vector<IsoPacket> packets;
};

struct Read
{
    std::size_t consumed = 0;       ///< bytes of the message; 0: not all of it is here yet
    bool broken = false;            ///< no message of USB/IP: the connection is of no use any more
    std::optional<Request> request; ///< present when `consumed` is not 0
};

/// Reads the message that `bytes` begins with. Transfers beyond 16 MiB or 1024 packets are called broken.
Read read_request(std::span<const std::uint8_t> bytes);

/// The answer to a kSubmit. `data` is what goes to the host (empty for an OUT transfer, whose `actual` counts what was
/// taken); for an isochronous transfer it is the packets' bytes one behind the other without gaps, and `packets` has
/// the lengths and statuses.
Bytes write_return(const Request& request, int status, std::size_t actual, std::span<const std::uint8_t> data,
                   std::span<const IsoPacket> packets);

/// The answer to a kUnlink: -ECONNRESET when the transfer was still here, 0 when it had been answered before.
Bytes write_unlinked(const Request& request, int status);

} // namespace dicot::usbip
