#include "dicot/camera_rig/stereo_camera.h"

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

namespace dicot {
namespace {

FrameTime time_of(const FrameLease& frame) noexcept
{
    return {frame->start_us, frame->verdict, frame->sequence};
}

} // namespace

Result<StereoFrames> StereoCamera::next()
{
    return one_at_a_time() ? next_in_turn() : next_at_once();
}

/// What the last pair looked at and did not take, or the next frame.
Result<FrameLease> StereoCamera::first_frame(Side& side)
{
    std::optional<FrameLease> ahead = std::exchange(side.ahead, std::nullopt);
    if (ahead && (*ahead)->start_us >= not_before_us_)
        return std::move(*ahead);
    ahead.reset();
    return whole_frame(side);
}

/// Walks along both streams, always on at the older frame, as long as its successor is nearer to the other one.
Result<StereoFrames> StereoCamera::next_at_once()
{
    constexpr int kMostSteps = 1024; // a camera that was shaken may be half a minute behind; clocks that run apart end
    FrameLease left = TRY(first_frame(left_));
    FrameLease right = TRY(first_frame(right_));
    for (int step = 0; step < kMostSteps; ++step) {
        const bool left_is_older = left->start_us <= right->start_us;
        FrameLease successor = TRY(whole_frame(left_is_older ? left_ : right_));
        FrameLease& older = left_is_older ? left : right;
        const std::array pair_of_older{time_of(older), time_of(successor)};
        const std::array other{time_of(left_is_older ? right : left)};
        const Pairing pairing = left_is_older ? best_pair(pair_of_older, other) : best_pair(other, pair_of_older);
        if ((left_is_older ? pairing.left : pairing.right) == 0) {
            (left_is_older ? left_ : right_).ahead = std::move(successor);
            return StereoFrames{std::move(left), std::move(right), pairing.skew_us};
        }
        older = std::move(successor);
    }
    return failure(Fault::kUnavailable,
                   "the times of both cameras' frames run apart: after %d frames they are %lld ms from each other",
                   kMostSteps, static_cast<long long>((right->start_us - left->start_us) / 1000));
}

Result<FrameLease> StereoCamera::frame_in_turn(Side& side)
{
    TRY(insist(side, [&] { return begin(side); }));
    FrameLease frame = TRY(whole_frame(side));
    (void)end(side); // the frame is there; a stream that does not end shows at the next start
    return frame;
}

Result<StereoFrames> StereoCamera::next_in_turn()
{
    FrameLease left = TRY(frame_in_turn(left_));
    FrameLease right = TRY(frame_in_turn(right_));
    const std::int64_t skew_us = right->start_us - left->start_us;
    return StereoFrames{std::move(left), std::move(right), skew_us};
}

} // namespace dicot
