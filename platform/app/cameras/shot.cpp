#include "shot.h"

#include "../take_picture.h"

#include "dicot/calibration/grey.h"
#include "dicot/os/clock.h"
#include "dicot/picture/write_picture.h"

#include <algorithm>
#include <chrono>

namespace dicot::app {
namespace {

struct Greys
{
    ImageView<std::uint8_t> left, right;
};

bool is_compared(int width, int height)
{
    return std::min(width, height) >= aiming::kMinViewSide && std::max(width, height) <= aiming::kMaxViewSide;
}

Greys take_greys(Arena& arena, int width, int height)
{
    const auto left = take_picture<std::uint8_t>(arena, width, height);
    return {left, take_picture<std::uint8_t>(arena, width, height)};
}

std::int64_t utc_us()
{
    return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

} // namespace

Shot::Shot(RigStream& rig, const Config& config, FileShelf* raw, std::int64_t clock_shift_us)
    : rig_(rig), raw_(raw), clock_shift_us_(clock_shift_us)
{
    rules_.pairs = config.burst.frames;
    rules_.average = config.burst.average;
    rules_.most_skew_us = static_cast<std::int64_t>(config.burst.most_skew_ms * 1000);
}

std::size_t Shot::scratch_bytes(int width, int height)
{
    Arena burst;
    const Burst measured(burst, width, height, {});
    Arena looking;
    (void)take_greys(looking, width, height);
    if (is_compared(width, height))
        (void)looking.take<std::byte>(aiming::view_scratch_bytes(width, height));
    return std::max(burst.peak(), looking.peak());
}

Status Shot::begin()
{
    TRY(rig_.start());
    return rig_.cameras().warm_up();
}

Status Shot::take(ImageView<Rgb8> left, ImageView<Rgb8> right, Arena scratch)
{
    const std::int64_t began_us = monotonic_us();
    const std::int64_t cpu_us = process_cpu_us();
    rig_.cameras().skip_to_now();
    {
        Arena arena = scratch;
        Burst burst(arena, left.width, left.height, rules_);
        figures_.burst = TRY(burst.take(rig_.cameras(), left, right));
    }
    figures_.taken_us = utc_us() + clock_shift_us_;
    figures_.ready_us = monotonic_us();
    look_at(left, right, scratch);
    figures_.wait_s = static_cast<double>(monotonic_us() - began_us) * 1e-6;
    figures_.cpu_s = static_cast<double>(process_cpu_us() - cpu_us) * 1e-6;
    return {};
}

void Shot::look_at(ImageView<const Rgb8> left, ImageView<const Rgb8> right, Arena scratch)
{
    figures_.left = luma_of(left);
    figures_.right = luma_of(right);
    figures_.views.reset();
    const Greys greys = take_greys(scratch, left.width, left.height);
    calibration::to_grey(left, greys.left);
    calibration::to_grey(right, greys.right);
    figures_.left_focus = aiming::focus_of(greys.left);
    figures_.right_focus = aiming::focus_of(greys.right);
    if (!is_compared(left.width, left.height))
        return;
    if (const Result<aiming::Views> views = aiming::compare_views(greys.left, greys.right, scratch); views.ok())
        figures_.views = views.value();
}

Status Shot::fill(ImageView<Rgb8> left, ImageView<Rgb8> right, Arena scratch)
{
    TRY(begin());
    TRY(take(left, right, scratch));
    TRY(end());
    if (raw_ == nullptr)
        return {};
    const auto put = [this](const char* name, ImageView<const Rgb8> picture) {
        return raw_->put(name, [&](ByteSink& sink) { return write_png(sink, name, picture); });
    };
    TRY(put("raw_left.png", left));
    return put("raw_right.png", right);
}

} // namespace dicot::app
