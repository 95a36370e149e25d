#include "dicot/camera_rig/stereo_camera.h"

#include "dicot/camera/luma.h"

#include <array>
#include <cstddef>

namespace dicot {

/// Feeds the pictures of streaming cameras until each of them is steady, or its bound is reached.
Status StereoCamera::settle(std::span<Side* const> sides)
{
    std::array settling{Settling(rules_.settling, now_us()), Settling(rules_.settling, now_us())};
    for (bool warming = true; warming;) {
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
        }
    }
    return {};
}

Status StereoCamera::converge(Side& side)
{
    return insist(side, [&] { return let_converge(*side.camera, rules_.power_line); });
}

Status StereoCamera::lock()
{
    const auto work = [&]() -> Status {
        figures_.lock = TRY(lock_exposure(*left_.camera, *right_.camera, rules_.power_line));
        return {};
    };
    const Status status = work();
    if (status.ok())
        return status;
    for (Side* side : {&left_, &right_}) // either of them may be the one that failed
        TRY(recover(*side, status));
    return work();
}

Status StereoCamera::warm_up()
{
    warming_ = true;
    const Status status = one_at_a_time() ? warm_up_in_turn() : warm_up_at_once();
    warming_ = false;
    return status;
}

Status StereoCamera::warm_up_at_once()
{
    const std::array sides{&left_, &right_};
    figures_.lock.reset();
    if (rules_.lock_exposure) {
        for (Side* side : sides)
            TRY(converge(*side));
        TRY(settle(sides));
        TRY(lock());
    }
    return settle(sides);
}

Status StereoCamera::warm_up_in_turn()
{
    figures_.lock.reset();
    for (Side* side : {&left_, &right_}) {
        TRY(insist(*side, [&] { return begin(*side); }));
        const bool leads = side == &left_ && rules_.lock_exposure;
        if (leads)
            TRY(converge(*side));
        TRY(settle(std::array{side}));
        if (leads)
            TRY(lock());
        TRY(end(*side));
    }
    return {};
}

} // namespace dicot
