#include "dicot/camera_rig/stereo_camera.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <cstring>

namespace dicot {

StereoCamera::StereoCamera(Camera& left, Camera& right, const StereoRules& rules) noexcept
    : rules_(rules), left_{.camera = &left,
                           .figures = &figures_.left,
                           .planned = &figures_.plan.left,
                           .ladder = Ladder(rules.ladder)},
      right_{
          .camera = &right, .figures = &figures_.right, .planned = &figures_.plan.right, .ladder = Ladder(rules.ladder)}
{
}

StereoCamera::~StereoCamera()
{
    (void)stop();
}

std::int64_t StereoCamera::now_us() const noexcept
{
    return rules_.virtual_now_us != nullptr ? *rules_.virtual_now_us : monotonic_us();
}

const StereoFigures& StereoCamera::figures() noexcept
{
    figures_.left.ladder = left_.ladder.figures();
    figures_.right.ladder = right_.ladder.figures();
    return figures_;
}

Status StereoCamera::stopped() const noexcept
{
    if (rules_.stop_asked == nullptr || !rules_.stop_asked())
        return {};
    return failure(Fault::kTryAgain, "stopped on request");
}

Status StereoCamera::begin(Side& side)
{
    if (side.streams)
        return {};
    TRY(side.camera->start(side.planned->mode));
    side.streams = true;
    side.fresh = rules_.frames_after_start;
    return {};
}

Status StereoCamera::end(Side& side)
{
    side.ahead.reset();
    if (!side.streams)
        return {};
    side.streams = false;
    return side.camera->stop();
}

Status StereoCamera::stop()
{
    const Status left = end(left_);
    const Status right = end(right_);
    return left.ok() ? right : left;
}

void StereoCamera::count(Side& side, const Frame& frame)
{
    SideFigures& figures = *side.figures;
    figures.lost += frame.lost_before;
    switch (frame.verdict) {
    case FrameVerdict::kWhole:
        ++figures.whole;
        return;
    case FrameVerdict::kWarmingUp:
        ++figures.warming_up;
        return;
    case FrameVerdict::kCancelled:
        ++figures.cancelled;
        break;
    case FrameVerdict::kTorn:
        ++figures.torn;
        break;
    }
    figures.last_flaw.assign(frame.flaw, std::strlen(frame.flaw));
}

/// A whole frame, or one that is whole but too early. Fails like Camera::next(), and after too many torn ones.
Result<FrameLease> StereoCamera::look(Side& side)
{
    for (int torn = 0; torn < rules_.most_torn; ++torn) {
        FrameLease frame = TRY(side.camera->next(now_us() + rules_.patience_us));
        if (frame->verdict == FrameVerdict::kWhole && (warming_ || side.fresh > 0))
            frame.judge(FrameVerdict::kWarmingUp);
        side.fresh = std::max(side.fresh - 1, 0);
        count(side, *frame);
        if (frame->verdict == FrameVerdict::kWhole || frame->verdict == FrameVerdict::kWarmingUp)
            return frame;
    }
    return failure(Fault::kTryAgain, "camera %s: %d torn frames in a row, the last with: %s",
                   side.camera->identity().port.text, rules_.most_torn, side.figures->last_flaw.text);
}

/// Shakes a camera until it delivers, or gives it up. A device that was opened again may have forgotten its controls.
Status StereoCamera::recover(Side& side, const Status& why)
{
    TRY(stopped());
    side.ahead.reset();
    const auto proof = [&](Camera& camera) -> Status {
        side.fresh = rules_.frames_after_start;
        TRY(begin(side));
        if (figures_.lock)
            TRY(lock_again(camera, *figures_.lock, &side == &left_));
        return look(side).status();
    };
    return climb(side.ladder, *side.camera, why, proof, [this] { return now_us(); });
}

Result<FrameLease> StereoCamera::whole_frame(Side& side)
{
    constexpr int kMostPassedOver = 64;
    constexpr std::int64_t kIntervals = 3;
    const std::int64_t interval_us = side.planned->mode.interval_100ns / 10;
    const std::int64_t most_age_us = std::max(rules_.most_age_us, kIntervals * interval_us);
    for (int passed_over = 0;;) { // each failure costs one of the ladder's shakes
        TRY(stopped());
        Result<FrameLease> frame = look(side);
        if (!frame.ok()) {
            TRY(recover(side, frame.status()));
            continue;
        }
        const std::int64_t start_us = frame.value()->start_us;
        const bool old = start_us < not_before_us_ || (rules_.most_age_us > 0 && now_us() - start_us > most_age_us);
        const bool early = frame.value()->verdict == FrameVerdict::kWarmingUp;
        if ((!old && !early) || ++passed_over > kMostPassedOver)
            return frame;
    }
}

/// Both cameras stream and deliver, or, one after the other, each of them does alone.
StereoCamera::Attempt StereoCamera::try_plan()
{
    for (Side* side : {&left_, &right_}) {
        if (Status status = begin(*side); !status.ok())
            return {status, side, false};
        if (!one_at_a_time())
            continue;
        if (Status status = look(*side).status(); !status.ok())
            return {status, side, true};
        if (Status status = end(*side); !status.ok())
            return {status, side, false};
    }
    if (!one_at_a_time())
        for (Side* side : {&left_, &right_})
            if (Status status = look(*side).status(); !status.ok())
                return {status, side, true};
    return {};
}

Status StereoCamera::start(ModePlanner& planner)
{
    constexpr int kSilencesOnTheBus = 3; // a bus that is too full shows as ENOSPC, or as a camera that is silent
    TRY(stop());
    int full = 0; // answers of the bus that it is
    int silences = 0;
    const auto is_a_way = [&](const BandwidthPlan& plan) {
        return plan.together == Together::kAtOnce ||
               (plan.together == Together::kOneAfterTheOther && rules_.one_after_the_other);
    };
    for (int refused = 0;;) {
        TRY(stopped());
        figures_.plan = planner.plan(refused);
        figures_.refused = refused;
        if (figures_.plan.together == Together::kNotAtAll)
            return failure(Fault::kUnavailable, "%s", figures_.plan.why);
        if (one_at_a_time() && !rules_.one_after_the_other)
            return failure(Fault::kUnavailable, "the cameras may not stream one after the other, and %s",
                           figures_.plan.why);
        const Attempt attempt = try_plan();
        if (attempt.status.ok())
            return {};
        (void)stop();
        const bool again = attempt.status.fault() == Fault::kTryAgain;
        const bool bus_full = again && !attempt.streamed;
        const bool silent = again && attempt.streamed && ++silences <= kSilencesOnTheBus;
        const bool less = bus_full || (silent && silences > 1);
        if (less && refused < kMostRefusals && is_a_way(planner.plan(refused + 1))) {
            ++refused;
            full += bus_full ? 1 : 0;
        } else if (!silent || silences > 1) {
            figures_.plan = planner.plan(refused = full);
            TRY(recover(*attempt.side, attempt.status));
            (void)stop();
        }
    }
}

} // namespace dicot
