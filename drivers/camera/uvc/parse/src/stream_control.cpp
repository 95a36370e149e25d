#include "dicot/uvc_parse/stream_control.h"

#include "bytes.h"

#include <algorithm>

namespace dicot {
namespace {

void put(std::span<std::byte> block, std::size_t at, std::size_t bytes, std::uint32_t value) noexcept
{
    for (std::size_t i = 0; i < bytes; ++i)
        block[at + i] = static_cast<std::byte>(value >> (8 * i));
}

} // namespace

void write_stream_control(const StreamControl& control, std::span<std::byte> block) noexcept
{
    std::ranges::fill(block, std::byte{0});
    if (block.size() < 26)
        return;
    put(block, 0, 2, control.hint);
    put(block, 2, 1, control.format_index);
    put(block, 3, 1, control.frame_index);
    put(block, 4, 4, control.interval_100ns);
    put(block, 8, 2, control.key_frame_rate);
    put(block, 10, 2, control.p_frame_rate);
    put(block, 12, 2, control.quality);
    put(block, 14, 2, control.window);
    put(block, 16, 2, control.delay_ms);
    put(block, 18, 4, control.most_frame_bytes);
    put(block, 22, 4, control.most_payload_bytes);
    if (block.size() < 34)
        return;
    put(block, 26, 4, control.clock_hz);
    put(block, 30, 1, control.framing);
    put(block, 31, 1, control.preferred_version);
    put(block, 32, 1, control.least_version);
    put(block, 33, 1, control.most_version);
}

Result<StreamControl> read_stream_control(std::span<const std::byte> block) noexcept
{
    if (block.size() < 26)
        return failure(Fault::kBadData, "it answers a probe with %zu of 26 bytes (UVC 4.3.1.1)", block.size());
    StreamControl control;
    control.hint = u16_at(block, 0);
    control.format_index = u8_at(block, 2);
    control.frame_index = u8_at(block, 3);
    control.interval_100ns = u32_at(block, 4);
    control.key_frame_rate = u16_at(block, 8);
    control.p_frame_rate = u16_at(block, 10);
    control.quality = u16_at(block, 12);
    control.window = u16_at(block, 14);
    control.delay_ms = u16_at(block, 16);
    control.most_frame_bytes = u32_at(block, 18);
    control.most_payload_bytes = u32_at(block, 22);
    if ((control.most_payload_bytes & 0xFFFF'0000u) == 0xFFFF'0000u)
        control.most_payload_bytes &= 0xFFFFu;
    if (block.size() >= 34) {
        control.clock_hz = u32_at(block, 26);
        control.framing = u8_at(block, 30);
        control.preferred_version = u8_at(block, 31);
        control.least_version = u8_at(block, 32);
        control.most_version = u8_at(block, 33);
    }
    return control;
}

} // namespace dicot
