// What a cloud's file says about itself beside its points.
#pragma once

#include "dicot/base/short_text.h"

#include <cstdint>
#include <optional>

namespace dicot {

/// What is not known stays empty and is not written. Unit ("m") and frame ("rectified-left x-right y-down z-forward")
/// are always the same and always written; the grid is written too (storage/FORMAT.md).
struct CloudMeta
{
    using Text = ShortText<95>;

    Text captured_at; ///< ISO 8601, UTC
    Text clock_trust; ///< how far captured_at can be trusted
    Text device_id;
    Text calibration_id; ///< id of the rig file
    Text software;
    std::optional<std::int64_t> sequence;
    std::optional<std::int64_t> skew_us; ///< capture of the right picture minus that of the left
    std::optional<double> near_mm;       ///< working range that the points were cut to
    std::optional<double> far_mm;

    friend bool operator==(const CloudMeta&, const CloudMeta&) = default;
};

inline constexpr const char* kCloudUnit = "m";
inline constexpr const char* kCloudFrame = "rectified-left x-right y-down z-forward";

} // namespace dicot
