// How recorded pictures are to behave as a camera: rate, skew and faults, as a small text.
#pragma once

#include "dicot/base/status.h"
#include "dicot/camera/camera.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace dicot {

enum class ReplayFault : std::uint8_t
{
    kDrop, ///< the frame is lost
    kTorn, ///< half of the frame arrives
    kHang, ///< from this frame on nothing arrives
    kGone, ///< at this frame the camera is unplugged
};

struct ReplayEvent
{
    ReplayFault fault{};
    std::uint32_t frame = 0;       ///< counted from 0 since the camera was opened, lost ones included
    std::optional<Shake> cured_by; ///< of kHang and kGone: the mildest shake that helps; none: nothing does
};

struct ReplayControl
{
    ControlRange range;
    bool stuck = false; ///< takes every value and keeps its own
};

struct ReplayScript
{
    static constexpr int kMostEvents = 64;

    std::uint32_t interval_100ns = 333333;
    std::int64_t skew_us = 0;
    std::uint32_t dark_frames = 0;
    std::uint32_t refused_starts = 0;
    std::array<ReplayEvent, kMostEvents> events{};
    int event_count = 0;
    std::array<ReplayControl, kControlCount> controls{};
    int control_count = 0;

    std::span<const ReplayEvent> all_events() const noexcept
    {
        return {events.data(), static_cast<std::size_t>(event_count)};
    }
};

/// Lines, or parts between semicolons; what stands behind '#' is a remark:
///
///     rate 15                         frames a second, 1 .. 240; 30
///     skew_us 300                     later than the other camera; -1000000 .. 1000000; 0
///     dark 10                         after each start, so many frames rise from black (not for JPEG); 0 .. 1000
///     full 2                          the first two starts are refused for want of bandwidth; 0 .. 100
///     drop 4                          frame 4 is lost
///     torn 5                          of frame 5 the first half arrives
///     hang 7 [restart|reopen|port]    nothing from frame 7 on, until shaken so hard; without a word: for ever
///     gone 9 [reopen|port]            unplugged at frame 9, likewise
///     control NAME LEAST MOST STEP USUAL [stuck]     a control that holds a value and changes no picture
///
/// Fault::kConfig with `name` and the line.
Result<ReplayScript> parse_replay_script(std::string_view text, const char* name) noexcept;

} // namespace dicot
