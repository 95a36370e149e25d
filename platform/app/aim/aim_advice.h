// What to do about the figures of two cameras, in words for somebody who stands beside them.
#pragma once

#include "aim_figures.h"

#include <string>
#include <vector>

namespace dicot::app {

/// Figures that call for nothing: smaller offsets are taken out by the rectification.
inline constexpr double kMostRollDeg = 1.0;
inline constexpr double kMostVerticalShare = 0.03; ///< of the height
inline constexpr int kLeastOverlapPercent = 70;
/// With fewer matches a rotation is not trusted.
inline constexpr int kMatchesForRoll = 60;

const char* focus_word(const aiming::Focus& focus) noexcept;
const char* light_word(const Light& light) noexcept;
bool roll_known(const aiming::Views& views) noexcept;

/// One sentence a thing to do, the most important first; empty if all is well.
std::vector<std::string> aim_advice(const AimMoment& now);

} // namespace dicot::app
