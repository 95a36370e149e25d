// The two halves of a video function: its control interface and one of its streaming interfaces.
#pragma once

#include "bytes.h"

#include "dicot/base/status.h"
#include "dicot/uvc_parse/descriptors.h"

#include <array>
#include <cstdint>

namespace dicot {

/// The streaming interfaces that a control interface names (UVC 3.7.2, baInterfaceNr).
struct Collection
{
    static constexpr int kMost = 16;
    std::uint8_t count = 0;
    std::array<std::uint8_t, kMost> interfaces{};
};

/// Fills version, clock and entities of `device` from control interface `number`.
Result<Collection> read_video_control(Bytes chain, std::uint8_t number, UvcDevice& device) noexcept;

/// Fills formats, frames and alternates of `device` from streaming interface `number`.
Status read_video_streaming(Bytes chain, std::uint8_t number, UvcDevice& device) noexcept;

} // namespace dicot
