#include "dicot/camera/control.h"

#include <algorithm>
#include <array>

namespace dicot {
namespace {

constexpr std::array<const char*, kControlCount> kNames{
    "exposure_auto", "exposure_time", "exposure_priority", "gain",  "white_balance_auto",
    "white_balance", "power_line",    "focus_auto",        "focus", "brightness",
    "contrast",      "saturation",    "sharpness",         "gamma", "backlight",
};

} // namespace

const char* name_of(ControlId id) noexcept
{
    return kNames[static_cast<std::size_t>(id)];
}

std::optional<ControlId> control_named(std::string_view name) noexcept
{
    const auto at = std::ranges::find(kNames, name, [](const char* known) { return std::string_view{known}; });
    if (at == kNames.end())
        return std::nullopt;
    return static_cast<ControlId>(at - kNames.begin());
}

std::int32_t nearest_value(const ControlRange& range, std::int32_t wanted) noexcept
{
    const std::int64_t step = std::max(range.step, 1);
    const std::int64_t held = std::clamp(wanted, range.least, std::max(range.least, range.most));
    const std::int64_t steps = (held - range.least + step / 2) / step;
    const std::int64_t value = range.least + steps * step;
    return static_cast<std::int32_t>(value > range.most ? value - step : value);
}

} // namespace dicot
