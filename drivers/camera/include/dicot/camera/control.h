// What can be set on a camera, in the words of UVC 1.5 (tables 4-9 and following) and of no driver.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace dicot {

/// Units are UVC's own, whatever stands behind it.
enum class ControlId : std::uint8_t
{
    kExposureAuto,     ///< 1 manual, 2 auto, 4 shutter priority, 8 aperture priority (UVC's bitmap)
    kExposureTime,     ///< 100 us
    kExposurePriority, ///< 1: the frame rate may vary
    kGain,
    kWhiteBalanceAuto,
    kWhiteBalance, ///< K
    kPowerLine,    ///< 0 off, 1 50 Hz, 2 60 Hz, 3 auto
    kFocusAuto,
    kFocus, ///< mm
    kBrightness,
    kContrast,
    kSaturation,
    kSharpness,
    kGamma,
    kBacklight,
};
constexpr int kControlCount = static_cast<int>(ControlId::kBacklight) + 1;

/// "exposure_time": the name in configurations and reports.
const char* name_of(ControlId id) noexcept;
std::optional<ControlId> control_named(std::string_view name) noexcept;

struct ControlRange
{
    ControlId id{};
    std::int32_t least = 0;
    std::int32_t most = 0;
    std::int32_t step = 1;
    std::int32_t usual = 0; ///< the device's own default
};

/// The value nearest to `wanted` that the device can have.
std::int32_t nearest_value(const ControlRange& range, std::int32_t wanted) noexcept;

} // namespace dicot
