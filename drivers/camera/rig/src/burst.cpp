#include "dicot/camera_rig/burst.h"

#include "dicot/camera/decode_frame.h"

#include <algorithm>
#include <cinttypes>
#include <cstdlib>
#include <utility>

namespace dicot {
namespace {

ImageView<Rgb8> take_picture(Arena& arena, int width, int height) noexcept
{
    return {arena.take<Rgb8>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)).data(), width, height};
}

void copy(ImageView<const Rgb8> from, ImageView<Rgb8> to) noexcept
{
    for (int y = 0; y < from.height; ++y)
        std::copy_n(from.row(y), from.width, to.row(y));
}

} // namespace

Burst::Burst(Arena& arena, int width, int height, const BurstRules& rules) noexcept
    : rules_(rules), left_average_(arena, width, height), right_average_(arena, width, height),
      left_now_(take_picture(arena, width, height)), right_now_(take_picture(arena, width, height))
{
}

bool Burst::is_better(const StereoFrames& frames, const BurstFigures& figures) noexcept
{
    if (!rules_.average)
        return figures.used == 0 || std::llabs(frames.skew_us) < std::llabs(figures.skew_us);
    const std::uint64_t sharpness = sharpness_q8(left_now_) + sharpness_q8(right_now_);
    if (figures.used > 0 && sharpness <= best_sharpness_)
        return false;
    best_sharpness_ = sharpness;
    return true;
}

Result<BurstFigures> Burst::take(StereoCamera& camera, ImageView<Rgb8> left, ImageView<Rgb8> right)
{
    BurstFigures figures;
    left_average_.begin();
    right_average_.begin();
    const bool any_skew = camera.one_at_a_time();
    Status undecodable;
    for (; figures.pairs < rules_.pairs; ++figures.pairs) {
        Result<StereoFrames> next = camera.next();
        if (!next.ok() && next.status().fault() != Fault::kTryAgain && figures.used > 0)
            break; // a camera died, but what it gave is good
        const StereoFrames frames = TRY(std::move(next));
        if (figures.pairs == 0 || std::llabs(frames.skew_us) < std::llabs(figures.least_skew_us))
            figures.least_skew_us = frames.skew_us;
        if (!any_skew && std::llabs(frames.skew_us) > rules_.most_skew_us) {
            ++figures.beyond_skew;
            continue;
        }
        Status decoded = decode_frame(*frames.left, left_now_);
        if (decoded.ok())
            decoded = decode_frame(*frames.right, right_now_);
        if (!decoded.ok()) {
            ++figures.undecodable;
            undecodable = decoded;
            continue;
        }
        if (is_better(frames, figures)) {
            copy(left_now_, left);
            copy(right_now_, right);
            figures.skew_us = frames.skew_us;
            figures.left_start_us = frames.left->start_us;
            figures.right_start_us = frames.right->start_us;
        }
        ++figures.used;
        if (rules_.average) {
            left_average_.add(left_now_);
            right_average_.add(right_now_);
        }
    }
    if (figures.used == 0)
        return failure(Fault::kUnavailable,
                       "of %d pairs %d began more than %" PRId64 " us apart (the nearest %" PRId64
                       " us) and %d could not be decoded%s%s",
                       figures.pairs, figures.beyond_skew, rules_.most_skew_us, figures.least_skew_us,
                       figures.undecodable, undecodable.ok() ? "" : ": ", undecodable.message());
    if (rules_.average) {
        figures.left = left_average_.finish(left);
        figures.right = right_average_.finish(right);
    }
    return figures;
}

} // namespace dicot
