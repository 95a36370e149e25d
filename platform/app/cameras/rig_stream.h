// The two cameras of a configuration as one stream of pairs.
#pragma once

#include "../config/config.h"
#include "camera_source.h"

#include "dicot/base/image.h"
#include "dicot/camera_rig/stereo_camera.h"

#include <cstdint>
#include <memory>

namespace dicot::app {

struct LivePair
{
    std::int64_t skew_us = 0;       ///< right minus left
    std::int64_t left_start_us = 0; ///< start of exposure, the clock of RigStream::now_us()
    std::int64_t right_start_us = 0;
};

/// What the configuration asks of the two cameras; `virtual_now_us` of CameraSource.
StereoRules stereo_rules(const Config& config, std::int64_t* virtual_now_us) noexcept;

/// Opened, not yet streaming. Every call is bounded as StereoCamera's are.
class RigStream
{
public:
    /// Errors: those of CameraSource::open().
    static Result<RigStream> open(const Config& config, Pace pace);

    int width() const noexcept { return source_->width(); } ///< px, of each picture
    int height() const noexcept { return source_->height(); }
    bool recorded() const noexcept { return source_->recorded(); }
    std::size_t reserved_bytes() const noexcept { return source_->reserved_bytes(); } ///< as of CameraSource
    Camera& left() noexcept { return source_->left(); }
    Camera& right() noexcept { return source_->right(); }
    StereoCamera& cameras() noexcept { return *cameras_; }
    std::int64_t now_us() const noexcept { return cameras_->now_us(); }

    Status start() { return cameras_->start(*source_); }
    Status stop() { return cameras_->stop(); }
    /// The next pair, decoded; pictures that cannot be decoded are passed over, a few in a row. `left` and `right` have
    /// the pictures' size. Errors: those of StereoCamera::next(); those of decode_frame().
    Result<LivePair> next(ImageView<Rgb8> left, ImageView<Rgb8> right);

private:
    RigStream(std::unique_ptr<CameraSource> source, const StereoRules& rules);

    std::unique_ptr<CameraSource> source_;
    std::unique_ptr<StereoCamera> cameras_; ///< goes before its cameras do
};

} // namespace dicot::app
