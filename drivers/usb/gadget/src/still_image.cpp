#include "still_image.h"

#include <algorithm>

namespace dicot::gadget_parts {
namespace {

constexpr std::uint8_t kToInterface = 0x21, kFromInterface = 0xa1; // class requests
constexpr std::uint16_t kOk = 0x2001, kBusy = 0x2019, kCancellation = 0x4001;
constexpr std::size_t kEventHeader = 12; ///< length, type, code, transaction

std::uint32_t get(std::span<const std::byte> bytes, std::size_t at, std::size_t count) noexcept
{
    std::uint32_t value = 0;
    for (std::size_t i = count; i-- > 0;)
        value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    return value;
}

void put(Ep0Answer& answer, std::uint32_t value, std::size_t count) noexcept
{
    for (std::size_t i = 0; i < count; ++i)
        answer.data[answer.bytes++] = static_cast<std::byte>(value >> (8 * i) & 0xff);
}

} // namespace

void StillImage::hear(Ep0Event event) noexcept
{
    switch (event) {
    case Ep0Event::kEnable:
        enabled_ = true;
        suspended_ = false;
        ++generation_;
        interrupted_ = under_way_;
        must_flush_ = reset_ = cancelled_ = false;
        event_bytes_ = 0;
        break;
    case Ep0Event::kDisable:
    case Ep0Event::kBind:
    case Ep0Event::kUnbind:
        enabled_ = suspended_ = false;
        interrupted_ = interrupted_ || under_way_;
        break;
    case Ep0Event::kSuspend:
        suspended_ = true;
        break;
    case Ep0Event::kResume:
        suspended_ = false;
        break;
    }
}

Ep0Answer StillImage::asked(const Setup& setup) const noexcept
{
    Ep0Answer answer;
    if (setup.type == kFromInterface && setup.request == kStatus)
        return status();
    if (setup.type == kFromInterface && setup.request == kExtendedEvent)
        return extended_event();
    if (setup.type == kToInterface && setup.request == kReset && setup.length == 0)
        answer.kind = Ep0Answer::Kind::kTake;
    if (setup.type == kToInterface && setup.request == kCancel && setup.length == kCancelBytes) {
        answer.kind = Ep0Answer::Kind::kTake;
        answer.bytes = kCancelBytes;
    }
    return answer;
}

bool StillImage::taken(const Setup& setup, std::span<const std::byte> data) noexcept
{
    if (setup.request == kReset) {
        reset_ = must_flush_ = true;
        interrupted_ = interrupted_ || under_way_;
        return true;
    }
    if (setup.request != kCancel || data.size() != kCancelBytes || get(data, 0, 2) != kCancellation)
        return false;
    // One transaction at a time: whatever number it bears, it is the one under way, or the one whose request waits.
    cancelled_ = must_flush_ = true;
    cancelled_id_ = get(data, 2, 4);
    interrupted_ = interrupted_ || under_way_;
    return true;
}

void StillImage::begin(std::uint32_t id) noexcept
{
    under_way_ = true;
    // The request waited here already when the host took it back.
    interrupted_ = must_flush_ && (reset_ || (cancelled_ && cancelled_id_ == id));
    cancelled_ = false;
}

bool StillImage::take_reset() noexcept
{
    const bool was = reset_;
    reset_ = false;
    return was;
}

Ep0Answer StillImage::status() const noexcept
{
    Ep0Answer answer;
    answer.kind = Ep0Answer::Kind::kSend;
    put(answer, 4, 2);
    put(answer, under_way_ || must_flush_ ? kBusy : kOk, 2);
    return answer;
}

void StillImage::posted(std::span<const std::byte> container) noexcept
{
    event_bytes_ = 0;
    if (container.size() < kEventHeader || container.size() > event_.size())
        return;
    std::copy(container.begin(), container.end(), event_.begin());
    event_bytes_ = container.size();
}

Ep0Answer StillImage::extended_event() const noexcept
{
    Ep0Answer answer;
    if (event_bytes_ == 0)
        return answer;
    answer.kind = Ep0Answer::Kind::kSend;
    put(answer, get(event_, 6, 2), 2);
    put(answer, get(event_, 8, 4), 4);
    const std::size_t words = (event_bytes_ - kEventHeader) / 4;
    put(answer, static_cast<std::uint32_t>(words), 2);
    for (std::size_t i = 0; i < words; ++i) {
        put(answer, 4, 2);
        put(answer, get(event_, kEventHeader + 4 * i, 4), 4);
    }
    return answer;
}

} // namespace dicot::gadget_parts
