// What is told of two cameras while a person turns and focuses them.
#pragma once

#include "dicot/aiming/focus.h"
#include "dicot/aiming/views.h"
#include "dicot/base/image.h"

#include <cstdint>

namespace dicot::app {

/// How bright one picture is.
struct Light
{
    int mean_luma = 0;            ///< 0 .. 255, BT.601
    double saturated_percent = 0; ///< pixels with a channel of kSaturated or more
    static constexpr int kSaturated = 250;
};

/// `colour` and `grey` show the same picture.
Light light_of(ImageView<const Rgb8> colour, ImageView<const std::uint8_t> grey) noexcept;

/// Outside of these a picture is too dark or too bright to be matched well.
inline constexpr int kLeastLuma = 45;
inline constexpr int kMostLuma = 195;
inline constexpr double kMostSaturatedPercent = 5;

struct AimSide
{
    aiming::Focus focus;
    int best_focus = aiming::Focus::kUnknown; ///< of all pictures so far
    Light light;
    double frames_per_s = 0; ///< whole ones; 0: not known yet
    std::uint64_t torn = 0;  ///< since the start
    std::uint64_t lost = 0;

    /// Takes the figures of another picture.
    void see(const aiming::Focus& sharpness, const Light& brightness) noexcept
    {
        focus = sharpness;
        light = brightness;
        if (focus.whole > best_focus)
            best_focus = focus.whole;
    }
};

/// Everything at one moment.
struct AimMoment
{
    double elapsed_s = 0;
    int width = 0, height = 0; ///< of a picture, px
    std::uint64_t pairs = 0;   ///< so far
    AimSide left, right;
    aiming::Views views;
    std::int64_t skew_us = 0;   ///< right minus left
    double most_skew_ms = 10;   ///< what a snapshot accepts
    bool one_at_a_time = false; ///< the bus carries one camera only: there is no skew to speak of
};

} // namespace dicot::app
