// A trustworthy pair from the cameras, and everything about it that is worth keeping.
#pragma once

#include "rig_stream.h"

#include "../cloud_work.h"

#include "dicot/aiming/focus.h"
#include "dicot/aiming/views.h"
#include "dicot/camera/luma.h"
#include "dicot/camera_rig/burst.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace dicot::app {

struct ShotFigures
{
    BurstFigures burst;
    LumaFigures left, right;               ///< of the pictures that were kept
    aiming::Focus left_focus, right_focus; ///< as those were
    std::optional<aiming::Views> views;    ///< none: pictures of a size that is not compared
    std::int64_t taken_us = 0;             ///< since 1970, UTC, when the pair was there
    std::int64_t ready_us = 0;             ///< the same, as monotonic_us() has it
    double wait_s = 0;                     ///< from asking to having it
    double cpu_s = 0;                      ///< processor time of that, all threads
};

/// Switches cameras on and takes pairs. Nothing is allocated outside the arenas after open().
class Shot final : public PairSource
{
public:
    /// `raw`: where fill() puts raw_left.png and raw_right.png, as the cameras saw them; null: nowhere.
    /// `clock_shift_us` is added to the system's clock.
    Shot(RigStream& rig, const Config& config, FileShelf* raw, std::int64_t clock_shift_us = 0);

    /// What take() and fill() need for pictures of this size.
    static std::size_t scratch_bytes(int width, int height);

    /// Streams, warmed up. Errors: those of StereoCamera::start() and warm_up().
    Status begin();
    /// One burst. Errors: those of Burst::take().
    Status take(ImageView<Rgb8> left, ImageView<Rgb8> right, Arena scratch);
    Status end() { return rig_.stop(); }
    /// One pair from beginning to end.
    Status fill(ImageView<Rgb8> left, ImageView<Rgb8> right, Arena scratch) override;

    const ShotFigures& figures() const noexcept { return figures_; }
    RigStream& rig() noexcept { return rig_; }

private:
    void look_at(ImageView<const Rgb8> left, ImageView<const Rgb8> right, Arena scratch);

    RigStream& rig_;
    BurstRules rules_;
    FileShelf* raw_;
    std::int64_t clock_shift_us_;
    ShotFigures figures_;
};

} // namespace dicot::app
