// The parts of judge_health(), each for what it looks at.
#pragma once

#include "judge_health.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <optional>

namespace dicot::app {

void judge_pictures(const HealthHistory& history, const HealthFigures& figures, HealthFlags& flags) noexcept;
void judge_rig(const HealthHistory& history, const HealthFigures& figures, HealthFlags& flags) noexcept;
void judge_board(const HealthHistory& history, const HealthFigures& figures, HealthFlags& flags) noexcept;

/// Of how many snapshots a figure's history is made, and how few of them are no history.
inline constexpr std::size_t kLooksBack = 20;
inline constexpr std::size_t kFewestForHistory = 5;

using HealthText = ShortText<191>;

__attribute__((format(printf, 1, 2))) inline HealthText health_text(const char* format, ...) noexcept
{
    char text[HealthText::kCapacity + 1];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

/// The median of the newest snapshots that know this figure; none: they are too few.
template <typename Figure>
std::optional<double> usual(const HealthHistory& history, const Figure& figure) noexcept
{
    std::array<double, kLooksBack> values{};
    std::size_t count = 0;
    for (std::size_t before = 0; before < history.size() && count < kLooksBack; ++before)
        if (const std::optional<double> value = figure(history.back(before)))
            values[count++] = *value;
    if (count < kFewestForHistory)
        return std::nullopt;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
}

} // namespace dicot::app
