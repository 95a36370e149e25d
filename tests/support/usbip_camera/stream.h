// The video endpoint: transfers that wait, and frames that fill them.
#pragma once

#include "fault_book.h"
#include "frames.h"
#include "negotiation.h"
#include "payload.h"
#include "wire.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

namespace dicot::usbip {

using Microseconds = std::int64_t; ///< of CLOCK_MONOTONIC

/// Frame k of a stream becomes due k intervals after its start and goes out whole, as fast as the host takes it; a host
/// that is too slow gets every frame later, and misses none.
///
/// An isochronous transfer for which there is no picture yet comes back with empty packets every kIdle; a bulk transfer
/// waits. A bulk transfer ends with its payload.
class VideoStream
{
public:
    static constexpr Microseconds kIdle = 16'000;

    struct Surroundings
    {
        const CameraModel& camera;
        const FrameFolder& frames;
        FaultBook& faults;
        std::function<void(Bytes)> answer; ///< takes messages for the host
        std::function<void(const std::string&)> log;
    };
    explicit VideoStream(Surroundings around) : around_(std::move(around)) {}

    /// `packet_bytes`: what the alternate setting allows a microframe; 0 for bulk. A stream that runs is stopped first.
    void start(const Agreement& agreement, int packet_bytes, Microseconds now);
    void stop();
    /// Whether anything of the present stream has gone out.
    bool has_begun() const { return running_ && (frame_ > 0 || sender_.has_value() || payload_open_); }
    /// Ends a hang and a halt, as a reset does.
    void reset() { hung_ = halted_ = false; }
    /// What CLEAR_FEATURE and SET_INTERFACE do to the endpoint.
    void clear_halt() { halted_ = false; }
    std::uint64_t streams() const { return streams_; } ///< started so far

    void submit(Request request) { waiting_.push_back(std::move(request)); }
    /// Whether the transfer still waited; it is then gone.
    bool unlink(std::uint32_t sequence);
    void drop_all() { waiting_.clear(); }

    /// Answers what can be answered. With a value the cable is to go now, and to come back after so long (0: never).
    [[nodiscard]] std::optional<Microseconds> serve(Microseconds now);
    /// When serve() is to be called again, whatever comes from the host.
    std::optional<Microseconds> deadline() const;

private:
    bool begin_frame(Microseconds now);
    bool answer_iso(const Request& request, Microseconds now);
    bool answer_bulk(const Request& request, Microseconds now);
    bool next_bulk_payload(Microseconds now);
    void end_frame();
    void answer_front(int status, std::span<const std::uint8_t> data, std::span<const IsoPacket> packets);

    Surroundings around_;
    std::deque<Request> waiting_;
    bool running_ = false;
    bool silent_ = false;
    bool hung_ = false;     ///< silent over the end of the stream
    bool halted_ = false;   ///< bulk: every transfer is refused
    Microseconds away_ = 0; ///< how long an unplugging of the present frame lasts
    bool frame_id_ = false;
    Agreement agreement_;
    int packet_bytes_ = 0;
    std::uint64_t streams_ = 0;
    std::int64_t frame_ = 0; ///< the one that goes out, or comes next
    Microseconds due_ = 0;
    Microseconds wake_ = 0; ///< when the next frame can begin, as far as is known
    Microseconds idle_due_ = 0;
    std::optional<FrameSender> sender_;
    Bytes payload_; ///< bulk: the payload that goes out, and how much of it has gone
    std::size_t payload_sent_ = 0;
    bool payload_open_ = false;    ///< bulk: the payload's transfer has not ended yet
    bool payload_unplugs_ = false; ///< bulk: the cable goes when the payload has gone
};

} // namespace dicot::usbip
