#include "dicot/replay/replay_camera.h"

#include "dicot/os/clock.h"
#include "dicot/os/shown_path.h"
#include "recording.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace dicot {
namespace {

constexpr std::size_t kPage = 4096;

} // namespace

Status ReplayCamera::open(std::span<const char* const> files, const ReplayOptions& options) noexcept
{
    if (files.empty())
        return failure(Fault::kNoInput, "%.60s: there are no pictures to replay; record some or name another folder",
                       options.port);
    replay::Recording first;
    std::size_t largest = 0;
    for (const char* path : files) {
        const replay::Recording one = TRY(replay::look_at(path));
        if (path == files.front())
            first = one;
        if (one.mode != first.mode)
            return failure(Fault::kBadData,
                           "%s: is %s of %d x %d where the first picture is %s of %d x %d; sort them apart",
                           shown_path(path), name_of(one.mode.format), one.mode.width, one.mode.height,
                           name_of(first.mode.format), first.mode.width, first.mode.height);
        largest = std::max(largest, one.bytes);
    }
    if (first.mode.format == PixelFormat::kMjpeg && options.script.dark_frames > 0)
        return failure(Fault::kConfig,
                       "%.60s: JPEG cannot be replayed dark; leave 'dark' out or convert the pictures to PNG",
                       options.port);
    const std::size_t slot_bytes = (largest + kPage - 1) / kPage * kPage;
    MemoryBlock memory = TRY(MemoryBlock::map(slot_bytes * kSlots));

    memory_ = std::move(memory);
    for (std::size_t i = 0; i < slots_.size(); ++i)
        slots_[i] = {.bytes = memory_.bytes().subspan(i * slot_bytes, slot_bytes)};
    files_ = files;
    options_ = options;
    identity_ = {};
    identity_.port.assign(options.port, std::strlen(options.port));
    constexpr std::string_view kName = "recorded pictures";
    identity_.name.assign(kName.data(), kName.size());
    identity_.driver = "replay";
    options_.port = identity_.port.text;
    offered_ = first.mode;
    offered_.interval_100ns = options.script.interval_100ns;
    for (int i = 0; i < options.script.control_count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        ranges_[at] = options.script.controls[at].range;
        values_[at] = ranges_[at].usual;
    }
    streaming_ = false;
    ailing_ = nullptr;
    starts_ = counted_ = 0;
    return {};
}

std::int64_t ReplayCamera::now_us() const noexcept
{
    return options_.virtual_now_us != nullptr ? *options_.virtual_now_us : monotonic_us();
}

void ReplayCamera::wait_until(std::int64_t when_us) noexcept
{
    if (options_.virtual_now_us != nullptr) {
        *options_.virtual_now_us = std::max(*options_.virtual_now_us, when_us);
        return;
    }
    const timespec when{static_cast<time_t>(when_us / 1'000'000), static_cast<long>(when_us % 1'000'000 * 1000)};
    while (when_us > 0 && ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr) == EINTR) {
    }
}

std::int64_t ReplayCamera::due_us() const noexcept
{
    return options_.epoch_us + options_.script.skew_us + index_ * mode_.interval_100ns / 10;
}

const ReplayEvent* ReplayCamera::event_now() const noexcept
{
    const auto events = options_.script.all_events();
    const auto found = std::ranges::find(events, counted_, &ReplayEvent::frame);
    return found == events.end() ? nullptr : &*found;
}

Status ReplayCamera::gone() const noexcept
{
    return failure(Fault::kUnavailable, "camera %s: is gone; check its plug and cable", identity_.port.text);
}

int ReplayCamera::control_at(ControlId id) const noexcept
{
    const auto known = controls();
    const auto found = std::ranges::find(known, id, &ControlRange::id);
    return found == known.end() ? -1 : static_cast<int>(found - known.begin());
}

Result<std::int32_t> ReplayCamera::get(ControlId id)
{
    const int at = control_at(id);
    if (at < 0)
        return failure(Fault::kUnavailable, "camera %s: has no control '%s'; leave it out", identity_.port.text,
                       name_of(id));
    if (ailing_ != nullptr && ailing_->fault == ReplayFault::kGone)
        return gone();
    return values_[static_cast<std::size_t>(at)];
}

Result<std::int32_t> ReplayCamera::set(ControlId id, std::int32_t value)
{
    TRY(get(id));
    const auto at = static_cast<std::size_t>(control_at(id));
    if (!options_.script.controls[at].stuck)
        values_[at] = nearest_value(ranges_[at], value);
    return values_[at];
}

Status ReplayCamera::start(const CameraMode& mode)
{
    TRY(stop());
    if (files_.empty() || (ailing_ != nullptr && ailing_->fault == ReplayFault::kGone))
        return gone();
    if (mode.format != offered_.format || mode.width != offered_.width || mode.height != offered_.height ||
        mode.interval_100ns == 0)
        return failure(Fault::kUnavailable,
                       "camera %s: its pictures are %s of %d x %d, not %s of %d x %d; ask for those",
                       identity_.port.text, name_of(offered_.format), offered_.width, offered_.height,
                       name_of(mode.format), mode.width, mode.height);
    if (starts_ < options_.script.refused_starts) {
        ++starts_;
        return failure(Fault::kTryAgain,
                       "camera %s: its bus has no bandwidth left for this mode, as the replay wants it",
                       identity_.port.text);
    }
    mode_ = mode;
    index_ = 0;
    const std::int64_t late_us = now_us() - due_us();
    if (late_us > 0)
        index_ = late_us * 10 / mode.interval_100ns;
    while (due_us() < now_us())
        ++index_;
    sequence_ = lost_ = 0;
    streaming_ = true;
    return {};
}

Frame ReplayCamera::fill(Slot& slot, bool torn) noexcept
{
    const auto at = static_cast<std::size_t>(index_ % static_cast<std::int64_t>(files_.size()));
    Frame frame;
    frame.mode = mode_;
    frame.verdict = FrameVerdict::kWhole;
    frame.sequence = sequence_;
    frame.lost_before = lost_;
    frame.start_us = due_us();
    const Result<std::size_t> read = replay::read_frame(files_[at], mode_, slot.bytes);
    const std::size_t bytes = read.ok() ? read.value() : 0;
    frame.bytes = slot.bytes.first(torn ? bytes / 2 : bytes);
    const std::uint32_t dark = options_.script.dark_frames;
    if (sequence_ < dark)
        replay::darken(mode_, slot.bytes.first(bytes), sequence_, dark);
    if (torn || !read.ok()) {
        frame.verdict = FrameVerdict::kTorn;
        if (read.ok())
            std::snprintf(slot.flaw, sizeof slot.flaw, "%zu of %zu bytes", frame.bytes.size(), bytes);
        else
            std::snprintf(slot.flaw, sizeof slot.flaw, "the recorded picture cannot be read");
        frame.flaw = slot.flaw;
    }
    return frame;
}

Result<FrameLease> ReplayCamera::next(std::int64_t deadline_us)
{
    if (!streaming_)
        return failure(Fault::kUnavailable, "camera %s: does not stream; start it first", identity_.port.text);
    const std::int64_t latest_us = std::min(deadline_us, now_us() + std::int64_t{kMostWaitMs} * 1000);
    const auto slot = std::ranges::find(slots_, false, &Slot::lent);
    if (slot == slots_.end())
        return failure(Fault::kTryAgain, "camera %s: all its %d buffers are lent; let a frame go first",
                       identity_.port.text, kSlots);
    for (;;) {
        const bool hangs = ailing_ != nullptr && ailing_->fault == ReplayFault::kHang;
        if (ailing_ != nullptr && !hangs)
            return gone();
        if (hangs || due_us() > latest_us) {
            wait_until(latest_us);
            return failure(Fault::kTryAgain, "camera %s: no frame came in time", identity_.port.text);
        }
        wait_until(due_us());
        const ReplayEvent* event = event_now();
        ++counted_;
        if (event != nullptr && (event->fault == ReplayFault::kHang || event->fault == ReplayFault::kGone)) {
            ailing_ = event;
            continue;
        }
        const bool dropped = event != nullptr && event->fault == ReplayFault::kDrop;
        if (!dropped) {
            slot->lent = true;
            const Frame frame = fill(*slot, event != nullptr);
            ++index_;
            ++sequence_;
            lost_ = 0;
            return FrameLease{*this, static_cast<int>(slot - slots_.begin()), frame};
        }
        ++index_;
        ++sequence_;
        ++lost_;
    }
}

Status ReplayCamera::stop()
{
    streaming_ = false;
    resume_ = false;
    return {};
}

Status ReplayCamera::shake(Shake how)
{
    if (ailing_ != nullptr && ailing_->cured_by && how >= *ailing_->cured_by)
        ailing_ = nullptr;
    const bool streamed = streaming_ || resume_;
    TRY(stop());
    resume_ = streamed;
    if (ailing_ != nullptr && ailing_->fault == ReplayFault::kGone)
        return gone();
    if (streamed)
        TRY(start(mode_));
    resume_ = false;
    return {};
}

void ReplayCamera::give_back(int slot) noexcept
{
    slots_[static_cast<std::size_t>(slot)].lent = false;
}

} // namespace dicot
