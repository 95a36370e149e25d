// The block that host and camera pass to and fro until they agree on a stream (UVC 1.5, 4.3.1.1).
#pragma once

#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// Video probe and commit controls (UVC 1.5, table 4-75), as far as an uncompressed or MJPEG stream has use for them.
struct StreamControl
{
    std::uint16_t hint = 0; ///< bmHint; bit 0: the frame interval is to stay
    std::uint8_t format_index = 0;
    std::uint8_t frame_index = 0;
    std::uint32_t interval_100ns = 0;
    std::uint16_t key_frame_rate = 0;
    std::uint16_t p_frame_rate = 0;
    std::uint16_t quality = 0;
    std::uint16_t window = 0;
    std::uint16_t delay_ms = 0;
    std::uint32_t most_frame_bytes = 0;   ///< dwMaxVideoFrameSize
    std::uint32_t most_payload_bytes = 0; ///< dwMaxPayloadTransferSize
    std::uint32_t clock_hz = 0;           ///< 0 before UVC 1.1
    std::uint8_t framing = 0;             ///< bmFramingInfo
    std::uint8_t preferred_version = 0;
    std::uint8_t least_version = 0;
    std::uint8_t most_version = 0;

    friend bool operator==(const StreamControl&, const StreamControl&) = default;
};

constexpr std::size_t kMostStreamControlBytes = 48;

/// 26 bytes of UVC 1.0, 34 of 1.1, 48 of 1.5.
constexpr std::size_t stream_control_bytes(std::uint16_t version) noexcept
{
    return version >= 0x0150 ? 48 : version >= 0x0110 ? 34 : 26;
}

/// Writes as much of `control` as `block` has room for (26, 34 or 48 bytes); what UVC 1.5 adds is 0.
void write_stream_control(const StreamControl& control, std::span<std::byte> block) noexcept;

/// Some cameras answer with a shorter block than they were asked for: what is not there stays 0. Fault::kBadData: fewer
/// than 26 bytes. A payload size with 0xFFFF in its upper half (a sign error of several chips) is mended.
Result<StreamControl> read_stream_control(std::span<const std::byte> block) noexcept;

} // namespace dicot
