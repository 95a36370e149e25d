#include "dicot/camera_rig/stereo_camera.h"

#include "dicot/camera/luma.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace dicot {
namespace {

constexpr std::int64_t kLeastUs = 2'000'000; // of the second phase

} // namespace

/// Feeds the pictures of streaming cameras until each of them is steady, or its bound is reached.
Status StereoCamera::settle(std::span<Side* const> sides, std::int64_t most_us)
{
    SettlingRules rules = rules_.settling;
    rules.most_us = most_us;
    std::array settling{Settling(rules, now_us()), Settling(rules, now_us())};
    for (bool warming = true; warming;) {
        TRY(stopped());
        warming = false;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const Result<FrameLease> frame = look(*sides[i]);
            if (!frame.ok())
                TRY(recover(*sides[i], frame.status()));
            const Result<LumaFigures> luma = frame.ok() ? luma_of(*frame.value()) : frame.status();
            const SettlingState state =
                luma.ok() ? settling[i].feed(luma.value().mean_q8, now_us()) : settling[i].note_time(now_us());
            sides[i]->figures->settling = settling[i].figures();
            warming |= state == SettlingState::kWarming;
            sides[i]->figures->settled &= state != SettlingState::kGaveUp;
        }
    }
    return {};
}

Status StereoCamera::converge(Side& side)
{
    return insist(side, [&] { return dicot::let_converge(*side.camera, rules_.power_line); });
}

Status StereoCamera::lock()
{
    const Camera* at_fault = nullptr;
    const auto work = [&]() -> Status {
        figures_.lock = TRY(lock_exposure(*left_.camera, *right_.camera, rules_.power_line, &at_fault));
        return {};
    };
    const Status status = work();
    if (status.ok())
        return status;
    Side& ill = at_fault == right_.camera ? right_ : left_;
    if (one_at_a_time()) // the bus carries one of them
        (void)end(&ill == &left_ ? right_ : left_);
    TRY(recover(ill, status));
    return work();
}

Status StereoCamera::let_converge()
{
    figures_.lock.reset();
    TRY(converge(left_));
    return converge(right_);
}

Status StereoCamera::warm_up()
{
    figures_.left.settled = figures_.right.settled = true;
    warming_ = true;
    const Status status = one_at_a_time() ? warm_up_in_turn() : warm_up_at_once();
    warming_ = false;
    return status;
}

Status StereoCamera::warm_up_at_once()
{
    const std::array sides{&left_, &right_};
    const std::int64_t until_us = now_us() + rules_.settling.most_us;
    TRY(let_converge());
    TRY(settle(sides, rules_.settling.most_us));
    if (!rules_.lock_exposure)
        return {};
    TRY(lock());
    return settle(sides, std::max(until_us - now_us(), kLeastUs));
}

Status StereoCamera::warm_up_in_turn()
{
    const std::int64_t until_us = now_us() + rules_.settling.most_us;
    figures_.lock.reset();
    for (Side* side : {&left_, &right_}) {
        TRY(insist(*side, [&] { return begin(*side); }));
        const bool leads = side == &left_ && rules_.lock_exposure;
        if (leads || !rules_.lock_exposure)
            TRY(converge(*side));
        const std::int64_t left_us = until_us - now_us();
        TRY(settle(std::array{side}, side == &left_ ? left_us : std::max(left_us, kLeastUs)));
        if (leads)
            TRY(lock());
        (void)end(*side);
    }
    return {};
}

} // namespace dicot
