#include "payload.h"

#include "model.h"

#include <algorithm>

namespace dicot::usbip {

namespace {

// Bits of the header's second byte, UVC 1.1 table 2-5.
enum HeadBit : std::uint8_t
{
    kFrameId = 1,
    kEndOfFrame = 2,
    kPresentationTime = 4,
    kSourceClock = 8,
    kError = 64,
    kEndOfHeader = 128,
};

constexpr std::uint8_t kFiller = 0xA5; // what an overlong frame goes on with

} // namespace

FrameSender::FrameSender(std::span<const std::uint8_t> frame, bool frame_id, std::uint32_t presented,
                         std::vector<PlannedFault> faults)
    : frame_(frame), frame_bytes_(frame.size()), frame_id_(frame_id), presented_(presented), faults_(std::move(faults))
{
    if (fault(FaultKind::kZeroFrame) != nullptr)
        frame_bytes_ = 0;
    if (const PlannedFault* cut = fault(FaultKind::kTruncate))
        frame_bytes_ = std::min(frame_bytes_, static_cast<std::size_t>(std::max<std::int64_t>((*cut)["byte"], 0)));
    if (const PlannedFault* more = fault(FaultKind::kOverlong))
        frame_bytes_ += static_cast<std::size_t>(std::clamp<std::int64_t>((*more)["bytes"], 0, 1 << 24));
}

const PlannedFault* FrameSender::fault(FaultKind kind) const
{
    const auto found =
        std::find_if(faults_.begin(), faults_.end(), [&](const PlannedFault& one) { return one.kind == kind; });
    return found == faults_.end() ? nullptr : &*found;
}

const PlannedFault* FrameSender::packet_fault(FaultKind kind) const
{
    const PlannedFault* planned = fault(kind);
    return planned != nullptr && touches_packet(*planned, packet_) ? planned : nullptr;
}

void FrameSender::append_head(Bytes& into, bool last, const DeviceTime& now) const
{
    int bits = kEndOfHeader | kPresentationTime | kSourceClock | (frame_id_ ? kFrameId : 0);
    if (last && fault(FaultKind::kNoEof) == nullptr)
        bits |= kEndOfFrame;
    into.push_back(kPayloadHeadBytes);
    into.push_back(static_cast<std::uint8_t>(bits));
    for (const std::uint32_t clock : {presented_, now.clock})
        for (const int shift : {0, 8, 16, 24})
            into.push_back(static_cast<std::uint8_t>(clock >> shift));
    into.push_back(static_cast<std::uint8_t>(now.bus_frame & 255));
    into.push_back(static_cast<std::uint8_t>(now.bus_frame >> 8 & 7));
}

Sent FrameSender::next(Bytes& into, std::size_t room, const DeviceTime& now)
{
    if (packet_fault(FaultKind::kHalt) != nullptr)
        return {.halt = true};
    const std::size_t start = into.size();
    std::size_t data = std::min(room - kPayloadHeadBytes, frame_bytes_ - sent_bytes_);
    Sent sent;
    if (const PlannedFault* cable = fault(FaultKind::kUnplug)) {
        const auto cut = static_cast<std::size_t>(std::max<std::int64_t>((*cable)["byte"], 0));
        if (sent_bytes_ + data >= std::min(cut, frame_bytes_)) {
            data = std::min(cut, frame_bytes_) - sent_bytes_;
            sent.unplug = true;
        }
    }
    const bool last = sent_bytes_ + data == frame_bytes_;
    append_head(into, last, now);
    const std::size_t whole = std::min(data, frame_.size() - std::min(sent_bytes_, frame_.size()));
    const auto part = frame_.subspan(std::min(sent_bytes_, frame_.size()), whole);
    into.insert(into.end(), part.begin(), part.end());
    into.resize(into.size() + data - whole, kFiller);
    sent_bytes_ += data;
    done_ = last;

    if (const PlannedFault* planned = packet_fault(FaultKind::kBadHeader))
        into[start] = static_cast<std::uint8_t>((*planned)["length"]);
    if (packet_fault(FaultKind::kWrongFid) != nullptr)
        into[start + 1] = static_cast<std::uint8_t>(into[start + 1] ^ kFrameId);
    if (packet_fault(FaultKind::kErr) != nullptr)
        into[start + 1] = static_cast<std::uint8_t>(into[start + 1] | kError);
    if (const PlannedFault* planned = packet_fault(FaultKind::kShort))
        into.resize(into.size() -
                    std::min<std::size_t>(static_cast<std::size_t>(std::max<std::int64_t>((*planned)["bytes"], 0)),
                                          into.size() - start));
    if (const PlannedFault* planned = packet_fault(FaultKind::kDrop)) {
        into.resize(start);
        sent.status = -static_cast<int>((*planned)["errno"]);
    }
    sent.bytes = into.size() - start;
    ++packet_;
    return sent;
}

} // namespace dicot::usbip
