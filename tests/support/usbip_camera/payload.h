// Cuts a frame into payloads with their headers (UVC 1.1, 2.4.3.3), and spoils them as planned.
#pragma once

#include "fault.h"
#include "wire.h"

#include <cstdint>
#include <span>
#include <vector>

namespace dicot::usbip {

/// The two clocks that a payload header tells: the device's own, and the bus's frame number.
struct DeviceTime
{
    std::uint32_t clock = 0;     ///< kClockHz
    std::uint16_t bus_frame = 0; ///< 11 bits, one a millisecond
};

/// What became of a payload that was to go out.
struct Sent
{
    std::size_t bytes = 0; ///< appended: header and data
    int status = 0;        ///< 0; negative errno: lost on the way
    bool unplug = false;   ///< the cable goes here
    bool halt = false;     ///< the endpoint halts here, for good
};

class FrameSender
{
public:
    /// `frame` is borrowed until it is done.
    FrameSender(std::span<const std::uint8_t> frame, bool frame_id, std::uint32_t presented,
                std::vector<PlannedFault> faults);

    bool done() const { return done_; }
    /// Appends the next payload, of at most `room` bytes with its header, room >= kPayloadHeadBytes + 1.
    Sent next(Bytes& into, std::size_t room, const DeviceTime& now);

private:
    const PlannedFault* fault(FaultKind kind) const;
    const PlannedFault* packet_fault(FaultKind kind) const;
    void append_head(Bytes& into, bool last, const DeviceTime& now) const;

    std::span<const std::uint8_t> frame_;
    std::size_t frame_bytes_; ///< those that go out: fewer or more than the frame has, if so planned
    bool frame_id_;
    std::uint32_t presented_;
    std::vector<PlannedFault> faults_;
    std::size_t sent_bytes_ = 0;
    std::int64_t packet_ = 0;
    bool done_ = false;
};

} // namespace dicot::usbip
