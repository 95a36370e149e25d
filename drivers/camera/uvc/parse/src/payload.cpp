#include "dicot/uvc_parse/payload.h"

#include "bytes.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace dicot {
namespace {

// bmHeaderInfo (UVC, table 2-6).
constexpr std::uint8_t kFrameId = 0x01;
constexpr std::uint8_t kEndOfFrame = 0x02;
constexpr std::uint8_t kPresentationTime = 0x04;
constexpr std::uint8_t kSourceClock = 0x08;
constexpr std::uint8_t kError = 0x40;

/// A device that has ended this many frames without ever toggling its frame id is one of those that never do.
constexpr int kNeverToggles = 4;

bool ends_as_jpeg(Bytes bytes) noexcept
{
    std::size_t end = bytes.size();
    while (end > 0 && u8_at(bytes, end - 1) == 0)
        --end;
    return end >= 4 && u8_at(bytes, end - 2) == 0xFF && u8_at(bytes, end - 1) == 0xD9;
}

bool begins_as_jpeg(Bytes bytes) noexcept
{
    return bytes.size() >= 2 && u8_at(bytes, 0) == 0xFF && u8_at(bytes, 1) == 0xD8;
}

} // namespace

void FrameAssembler::restart(const PayloadRules& rules) noexcept
{
    *this = FrameAssembler{};
    rules_ = rules;
}

std::optional<FrameAssembler::Header> FrameAssembler::header_of(Bytes payload) noexcept
{
    if (payload.size() < 2)
        return std::nullopt;
    const std::size_t length = u8_at(payload, 0);
    if (length < 2 || length > payload.size())
        return std::nullopt;
    return Header{length, u8_at(payload, 1)};
}

FrameAssembler::Fed FrameAssembler::feed(Bytes bytes, bool last, std::int64_t arrival_us) noexcept
{
    Bytes data = bytes;
    if (!in_payload_) {
        if (bytes.empty())
            return Fed::kMore;
        const std::optional<Header> header = header_of(bytes);
        skip_payload_ = !header;
        end_of_frame_ = false;
        if (!header) {
            lose("bad payload header");
        } else {
            const std::uint8_t id = header->flags & kFrameId;
            data = bytes.subspan(header->length);
            if (open_ && id != frame_id_) {
                close();
                return Fed::kClosedBefore;
            }
            if (!open_ && id == frame_id_ && data.empty())
                skip_payload_ = true;
            else if (!open_)
                open(id);
            if (open_) {
                note_time(*header, bytes, arrival_us);
                end_of_frame_ = (header->flags & kEndOfFrame) != 0;
                if ((header->flags & kError) != 0) {
                    lose("error bit");
                    skip_payload_ = true;
                }
            }
        }
        in_payload_ = true;
        payload_bytes_ = 0;
    }
    if (!skip_payload_)
        add(data, arrival_us);
    payload_bytes_ += bytes.size();
    if (!last && (rules_.most_payload_bytes == 0 || payload_bytes_ < rules_.most_payload_bytes))
        return Fed::kMore;
    in_payload_ = false;
    if (!open_ || !end_of_frame_)
        return Fed::kMore;
    ended_without_toggle_ = toggles_ ? 0 : std::min(ended_without_toggle_ + 1, kNeverToggles);
    close();
    return Fed::kClosed;
}

void FrameAssembler::open(std::uint8_t frame_id) noexcept
{
    open_ = true;
    held_ = 0;
    claimed_ = 0;
    first_data_us_ = 0;
    has_device_start_ = false;
    if (frame_id_ >= 0 && frame_id != frame_id_)
        toggles_ = true;
    else if (frame_id == frame_id_ && (toggles_ || ended_without_toggle_ < kNeverToggles))
        lose("frame id did not toggle");
    frame_id_ = frame_id;
}

void FrameAssembler::note_time(const Header& header, Bytes payload, std::int64_t arrival_us) noexcept
{
    constexpr std::uint8_t both = kPresentationTime | kSourceClock;
    if (has_device_start_ || (header.flags & both) != both || header.length < 12 || rules_.clock_hz == 0)
        return;
    const DeviceTime time{u32_at(payload, 2), u32_at(payload, 6)};
    device_start_us_ = start_of_frame_us(time, rules_.clock_hz, arrival_us);
    has_device_start_ = device_start_us_ != arrival_us;
}

void FrameAssembler::add(Bytes data, std::int64_t arrival_us) noexcept
{
    if (data.empty())
        return;
    if (claimed_ == 0)
        first_data_us_ = arrival_us;
    claimed_ += data.size();
    const std::size_t kept = std::min(data.size(), buffer_.size() - held_);
    if (kept != 0)
        std::memcpy(buffer_.data() + held_, data.data(), kept);
    held_ += kept;
}

void FrameAssembler::lose(const char* why) noexcept
{
    if (flaw_ == nullptr)
        flaw_ = why;
}

FrameAssembler::Fed FrameAssembler::cancel(const char* why) noexcept
{
    in_payload_ = false;
    if (!open_)
        return Fed::kMore;
    close();
    closed_.verdict = FrameVerdict::kCancelled;
    std::snprintf(closed_.flaw, sizeof closed_.flaw, "%s", why);
    return Fed::kClosed;
}

void FrameAssembler::judge() noexcept
{
    const auto torn = [&](const char* why) { std::snprintf(closed_.flaw, sizeof closed_.flaw, "%s", why); };
    const Bytes kept = std::span<const std::byte>{buffer_}.first(held_);
    closed_.verdict = FrameVerdict::kTorn;
    if (flaw_ != nullptr)
        torn(flaw_);
    else if (claimed_ == 0)
        torn("no bytes");
    else if (rules_.exact_bytes != 0 && claimed_ != rules_.exact_bytes)
        std::snprintf(closed_.flaw, sizeof closed_.flaw, "%zu of %zu bytes", claimed_, rules_.exact_bytes);
    else if (claimed_ > held_)
        std::snprintf(closed_.flaw, sizeof closed_.flaw, "%zu bytes, room for %zu", claimed_, held_);
    else if (rules_.jpeg && !begins_as_jpeg(kept))
        torn("no JPEG start marker");
    else if (rules_.jpeg && !ends_as_jpeg(kept))
        torn("no JPEG end marker");
    else
        closed_.verdict = FrameVerdict::kWhole;
}

void FrameAssembler::close() noexcept
{
    closed_ = {};
    closed_.bytes = held_;
    closed_.start_us = has_device_start_ ? device_start_us_ : first_data_us_;
    judge();
    open_ = false;
    flaw_ = nullptr;
    buffer_ = {};
    held_ = 0;
}

} // namespace dicot
