#include "rig_stream.h"

#include "../stop_request.h"

#include "dicot/camera/decode_frame.h"
#include "dicot/os/stage_watch.h"

#include <limits>
#include <utility>

namespace dicot::app {

namespace {

/// Asked before each frame: a step was made.
bool is_to_end() noexcept
{
    StageWatch::progress();
    return StopRequest::asked() || StageWatch::overrun();
}

} // namespace

StereoRules stereo_rules(const Config& config, std::int64_t* virtual_now_us) noexcept
{
    StereoRules rules;
    rules.settling.most_us = static_cast<std::int64_t>(config.exposure.warm_up_s * 1e6);
    rules.settling.most_frames = std::numeric_limits<std::uint32_t>::max(); // the time bounds it
    rules.stop_asked = is_to_end;
    rules.lock_exposure = config.exposure.lock;
    rules.power_line = config.exposure.power_line_hz == 0    ? PowerLine::kOff
                       : config.exposure.power_line_hz == 60 ? PowerLine::k60Hz
                                                             : PowerLine::k50Hz;
    rules.one_after_the_other = config.burst.one_after_the_other;
    rules.virtual_now_us = virtual_now_us;
    return rules;
}

RigStream::RigStream(std::unique_ptr<CameraSource> source, const StereoRules& rules)
    : source_(std::move(source)), cameras_(std::make_unique<StereoCamera>(source_->left(), source_->right(), rules))
{
}

Result<RigStream> RigStream::open(const Config& config, Pace pace)
{
    std::unique_ptr<CameraSource> source = TRY(CameraSource::open(config.cameras, pace));
    StereoRules rules = stereo_rules(config, source->virtual_now_us());
    if (pace == Pace::kReal && !source->recorded())
        rules.most_age_us = 250'000; // of a slow reader the buffers hold what was long ago
    return RigStream(std::move(source), rules);
}

Result<LivePair> RigStream::next(ImageView<Rgb8> left, ImageView<Rgb8> right)
{
    constexpr int kMostUndecodable = 30;
    Status why;
    for (int k = 0; k < kMostUndecodable; ++k) {
        const StereoFrames frames = TRY(cameras_->next());
        why = decode_frame(*frames.left, left);
        if (why.ok())
            why = decode_frame(*frames.right, right);
        if (why.ok())
            return LivePair{frames.skew_us, frames.left->start_us, frames.right->start_us};
    }
    return why;
}

} // namespace dicot::app
