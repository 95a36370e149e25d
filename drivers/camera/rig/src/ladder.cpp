#include "dicot/camera_rig/ladder.h"

#include <cinttypes>
#include <cstring>

namespace dicot {

std::optional<Shake> Ladder::failed(const char* why, std::int64_t now_us) noexcept
{
    if (figures_.gave_up)
        return std::nullopt;
    figures_.last_reason.assign(why, std::strlen(why));
    if (!climbing_) {
        climbing_ = true;
        since_us_ = now_us;
        figures_.first_reason = figures_.last_reason;
    }
    if (all_shakes_ < rules_.most_shakes && now_us - since_us_ < rules_.most_us) {
        for (std::size_t step = 0; step < tried_.size(); ++step) {
            if (tried_[step] >= rules_.tries[step])
                continue;
            ++tried_[step];
            ++figures_.shakes[step];
            ++all_shakes_;
            return static_cast<Shake>(step);
        }
    }
    figures_.gave_up = true;
    return std::nullopt;
}

void Ladder::delivered() noexcept
{
    if (figures_.gave_up || !climbing_)
        return;
    climbing_ = false;
    tried_ = {};
    ++figures_.recoveries;
}

Status Ladder::verdict(const char* port) const noexcept
{
    if (!figures_.gave_up)
        return {};
    return failure(Fault::kUnavailable,
                   "camera %s: given up after %" PRIu32 " restarts, %" PRIu32 " reopens and %" PRIu32
                   " port resets; at first: %s; at last: %s",
                   port, figures_.shakes[0], figures_.shakes[1], figures_.shakes[2], figures_.first_reason.text,
                   figures_.last_reason.text);
}

Status wait_for_whole_frame(Camera& camera, std::int64_t deadline_us, int most_frames) noexcept
{
    const char* port = camera.identity().port.text;
    Status torn = failure(Fault::kTryAgain, "camera %s: no frame was asked for", port);
    for (int k = 0; k < most_frames; ++k) {
        const Result<FrameLease> frame = camera.next(deadline_us);
        if (!frame.ok())
            return frame.status();
        if (frame.value()->verdict == FrameVerdict::kWhole)
            return {};
        torn = failure(Fault::kTryAgain, "camera %s: no whole frame among %d, the last is %s (%s)", port, k + 1,
                       name_of(frame.value()->verdict), frame.value()->flaw);
    }
    return torn;
}

} // namespace dicot
