#include "stream.h"

#include <algorithm>
#include <cerrno>

namespace dicot::usbip {

namespace {

constexpr Microseconds kMicrosecondsPerInterval = 10; // intervals count 100 ns

DeviceTime device_time(Microseconds now)
{
    return {static_cast<std::uint32_t>(static_cast<std::uint64_t>(now) * (kClockHz / 1'000'000)),
            static_cast<std::uint16_t>(now / 1000 & 0x7FF)};
}

} // namespace

void VideoStream::start(const Agreement& agreement, int packet_bytes, Microseconds now)
{
    stop();
    agreement_ = agreement;
    packet_bytes_ = packet_bytes;
    running_ = true;
    silent_ = hung_;
    ++streams_;
    frame_ = 0;
    due_ = now;
    wake_ = now;
    idle_due_ = now + kIdle;
    const Format& format = around_.camera.formats[agreement.format];
    const Mode& mode = format.modes[agreement.mode];
    around_.log("stream " + std::to_string(streams_) +
                " starts: " + (format.pixels == Pixels::kYuyv ? "yuyv " : "mjpeg ") + std::to_string(mode.width) + "x" +
                std::to_string(mode.height) + ", interval " + std::to_string(agreement.interval_100ns) + " x 100 ns, " +
                (packet_bytes > 0 ? std::to_string(packet_bytes) + " bytes a microframe" : std::string("bulk")));
}

void VideoStream::stop()
{
    if (running_)
        around_.log("stream " + std::to_string(streams_) + " stops after " + std::to_string(frame_) + " whole frames");
    running_ = false;
    sender_.reset();
    payload_open_ = false;
    payload_unplugs_ = false;
}

bool VideoStream::unlink(std::uint32_t sequence)
{
    return std::erase_if(waiting_, [&](const Request& request) { return request.sequence == sequence; }) > 0;
}

bool VideoStream::begin_frame(Microseconds now)
{
    if (!running_ || silent_)
        return false;
    std::vector<PlannedFault> faults = around_.faults.in_frame(streams_, frame_);
    std::erase_if(faults, [&](const PlannedFault& fault) { // isochronous endpoints know no halt
        return fault.kind == FaultKind::kHalt && packet_bytes_ > 0;
    });
    Microseconds late = 0;
    for (const PlannedFault& fault : faults)
        if (fault.kind == FaultKind::kLate)
            late += fault["ms"] * 1000;
    wake_ = due_ + late;
    if (now < wake_)
        return false;
    for (const PlannedFault& fault : faults) {
        around_.log("stream " + std::to_string(streams_) + " frame " + std::to_string(frame_) + ": " + fault.word);
        if (fault.kind == FaultKind::kUnplug)
            away_ = fault["back_ms"] * 1000;
        hung_ = hung_ || fault.kind == FaultKind::kHang;
        silent_ = silent_ || hung_ || fault.kind == FaultKind::kSilent;
    }
    if (silent_)
        return false;
    const auto picture = around_.frames.frame(agreement_.format, agreement_.mode, static_cast<std::uint64_t>(frame_));
    sender_.emplace(picture, frame_id_, device_time(now).clock, std::move(faults));
    return true;
}

void VideoStream::end_frame()
{
    sender_.reset();
    frame_id_ = !frame_id_;
    ++frame_;
    due_ += static_cast<Microseconds>(agreement_.interval_100ns) / kMicrosecondsPerInterval;
    wake_ = due_;
}

void VideoStream::answer_front(int status, std::span<const std::uint8_t> data, std::span<const IsoPacket> packets)
{
    around_.answer(write_return(waiting_.front(), status, data.size(), data, packets));
    waiting_.pop_front();
}

bool VideoStream::answer_iso(const Request& request, Microseconds now)
{
    std::vector<IsoPacket> packets = request.packets;
    Bytes data;
    data.reserve(request.length);
    bool unplug = false;
    for (IsoPacket& packet : packets) {
        if (!sender_ || unplug)
            break;
        const std::size_t room =
            std::min({static_cast<std::size_t>(packet.length), static_cast<std::size_t>(packet_bytes_),
                      static_cast<std::size_t>(agreement_.payload_bytes)});
        if (room <= kPayloadHeadBytes)
            continue;
        const Sent sent = sender_->next(data, room, device_time(now));
        packet.actual_length = static_cast<std::uint32_t>(sent.bytes);
        packet.status = sent.status;
        unplug = sent.unplug;
        if (sender_->done() && !unplug)
            end_frame();
    }
    answer_front(0, data, packets);
    idle_due_ = now + kIdle;
    return unplug;
}

// Lost payloads never reach the wire: the next one takes their place.
bool VideoStream::next_bulk_payload(Microseconds now)
{
    payload_.clear();
    payload_sent_ = 0;
    while (sender_ && payload_.empty()) {
        const Sent sent = sender_->next(payload_, agreement_.payload_bytes, device_time(now));
        payload_unplugs_ = sent.unplug;
        halted_ = sent.halt;
        if (sent.unplug || sent.halt)
            break;
        if (sender_->done())
            end_frame();
    }
    payload_open_ = !payload_.empty();
    return payload_open_;
}

bool VideoStream::answer_bulk(const Request& request, Microseconds now)
{
    if (!payload_open_ && !next_bulk_payload(now))
        return payload_unplugs_;
    const std::size_t part = std::min<std::size_t>(request.length, payload_.size() - payload_sent_);
    const bool ends_short = part < request.length; // by a short packet, or by one without bytes
    const auto data = std::span(payload_).subspan(payload_sent_, part);
    payload_sent_ += part;
    // A payload of the full size ends by its size alone; a shorter one has to end short.
    payload_open_ = !ends_short && !(payload_sent_ == payload_.size() && payload_.size() >= agreement_.payload_bytes);
    answer_front(0, data, {});
    return payload_unplugs_ && !payload_open_;
}

std::optional<Microseconds> VideoStream::serve(Microseconds now)
{
    while (!waiting_.empty() && !halted_ && (sender_ || payload_open_ || begin_frame(now))) {
        const bool iso = !waiting_.front().packets.empty();
        if (iso ? answer_iso(waiting_.front(), now) : answer_bulk(waiting_.front(), now))
            return away_;
    }
    while (!waiting_.empty() && halted_)
        answer_front(-EPIPE, {}, {});
    if (!waiting_.empty() && !waiting_.front().packets.empty() && now >= idle_due_) {
        answer_front(0, {}, waiting_.front().packets);
        idle_due_ = now + kIdle;
    }
    return std::nullopt;
}

std::optional<Microseconds> VideoStream::deadline() const
{
    if (waiting_.empty())
        return std::nullopt;
    if (!waiting_.front().packets.empty())
        return running_ && !silent_ ? std::min(wake_, idle_due_) : idle_due_;
    return running_ && !silent_ ? std::optional(wake_) : std::nullopt;
}

} // namespace dicot::usbip
