#include "wire.h"

namespace dicot::usbip {

namespace {

constexpr std::size_t kHeadBytes = 48;
constexpr std::size_t kPacketBytes = 16;
constexpr std::uint32_t kMaxTransferBytes = 16u << 20;
constexpr std::uint32_t kMaxPackets = 1024;
constexpr std::uint32_t kNoPackets = 0xFFFFFFFFu;

enum Command : std::uint32_t
{
    kCmdSubmit = 1,
    kCmdUnlink = 2,
    kRetSubmit = 3,
    kRetUnlink = 4,
};

std::uint32_t number_at(std::span<const std::uint8_t> bytes, std::size_t at)
{
    return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 | std::uint32_t{bytes[at + 2]} << 8 |
           bytes[at + 3];
}

void append(Bytes& bytes, std::uint32_t number)
{
    for (const int shift : {24, 16, 8, 0})
        bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

// The five numbers that every message begins with; in answers the last three are zero.
void append_head(Bytes& bytes, Command command, std::uint32_t sequence)
{
    append(bytes, command);
    append(bytes, sequence);
    for (int i = 0; i < 3; ++i)
        append(bytes, 0);
}

Read broken()
{
    Read read;
    read.broken = true;
    return read;
}

} // namespace

Read read_request(std::span<const std::uint8_t> bytes)
{
    if (bytes.size() < kHeadBytes)
        return {};
    Request request;
    request.sequence = number_at(bytes, 4);
    request.in = number_at(bytes, 12) == 1;
    request.endpoint = number_at(bytes, 16) & 15;
    Read read;
    const std::uint32_t command = number_at(bytes, 0);
    if (command == kCmdUnlink) {
        request.kind = Request::Kind::kUnlink;
        request.victim = number_at(bytes, 20);
        read.consumed = kHeadBytes;
        read.request = std::move(request);
        return read;
    }
    if (command != kCmdSubmit)
        return broken();

    request.length = number_at(bytes, 24);
    request.start_frame = number_at(bytes, 28);
    const std::uint32_t told = number_at(bytes, 32);
    const std::uint32_t packets = told == kNoPackets ? 0 : told;
    if (request.length > kMaxTransferBytes || packets > kMaxPackets)
        return broken();
    for (std::size_t i = 0; i < request.setup.size(); ++i)
        request.setup[i] = bytes[40 + i];
    const std::size_t out_bytes = request.in ? 0 : request.length;
    const std::size_t whole = kHeadBytes + out_bytes + packets * kPacketBytes;
    if (bytes.size() < whole)
        return {};
    const auto out = bytes.subspan(kHeadBytes, out_bytes);
    request.out.assign(out.begin(), out.end());
    for (std::uint32_t i = 0; i < packets; ++i) {
        const std::size_t at = kHeadBytes + out_bytes + i * kPacketBytes;
        request.packets.push_back({number_at(bytes, at), number_at(bytes, at + 4), 0, 0});
    }
    read.consumed = whole;
    read.request = std::move(request);
    return read;
}

Bytes write_return(const Request& request, int status, std::size_t actual, std::span<const std::uint8_t> data,
                   std::span<const IsoPacket> packets)
{
    Bytes bytes;
    bytes.reserve(kHeadBytes + data.size() + packets.size() * kPacketBytes);
    append_head(bytes, kRetSubmit, request.sequence);
    append(bytes, static_cast<std::uint32_t>(status));
    append(bytes, static_cast<std::uint32_t>(actual));
    append(bytes, request.start_frame);
    append(bytes, static_cast<std::uint32_t>(packets.size()));
    std::uint32_t errors = 0;
    for (const IsoPacket& packet : packets)
        errors += packet.status != 0 ? 1 : 0;
    append(bytes, errors);
    bytes.resize(kHeadBytes);
    bytes.insert(bytes.end(), data.begin(), data.end());
    for (const IsoPacket& packet : packets) {
        append(bytes, packet.offset);
        append(bytes, packet.length);
        append(bytes, packet.actual_length);
        append(bytes, static_cast<std::uint32_t>(packet.status));
    }
    return bytes;
}

Bytes write_unlinked(const Request& request, int status)
{
    Bytes bytes;
    append_head(bytes, kRetUnlink, request.sequence);
    append(bytes, static_cast<std::uint32_t>(status));
    bytes.resize(kHeadBytes);
    return bytes;
}

} // namespace dicot::usbip
