#include "kernel_words.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace dicot::v4l2 {
namespace {

constexpr std::array<std::pair<std::uint32_t, PixelFormat>, 4> kFormats{{
    {V4L2_PIX_FMT_YUYV, PixelFormat::kYuyv},
    {V4L2_PIX_FMT_MJPEG, PixelFormat::kMjpeg},
    {V4L2_PIX_FMT_NV12, PixelFormat::kNv12},
    {V4L2_PIX_FMT_GREY, PixelFormat::kGrey},
}};

/// In the order of ControlId.
constexpr std::array<std::uint32_t, kControlCount> kIds{
    V4L2_CID_EXPOSURE_AUTO,
    V4L2_CID_EXPOSURE_ABSOLUTE,
    V4L2_CID_EXPOSURE_AUTO_PRIORITY,
    V4L2_CID_GAIN,
    V4L2_CID_AUTO_WHITE_BALANCE,
    V4L2_CID_WHITE_BALANCE_TEMPERATURE,
    V4L2_CID_POWER_LINE_FREQUENCY,
    V4L2_CID_FOCUS_AUTO,
    V4L2_CID_FOCUS_ABSOLUTE,
    V4L2_CID_BRIGHTNESS,
    V4L2_CID_CONTRAST,
    V4L2_CID_SATURATION,
    V4L2_CID_SHARPNESS,
    V4L2_CID_GAMMA,
    V4L2_CID_BACKLIGHT_COMPENSATION,
};

struct ExposureMode
{
    std::int32_t kernel, uvc;
};
constexpr std::array<ExposureMode, 4> kExposureModes{{
    {V4L2_EXPOSURE_AUTO, 2},
    {V4L2_EXPOSURE_MANUAL, 1},
    {V4L2_EXPOSURE_SHUTTER_PRIORITY, 4},
    {V4L2_EXPOSURE_APERTURE_PRIORITY, 8},
}};

std::int32_t held(std::int64_t value) noexcept
{
    using Limits = std::numeric_limits<std::int32_t>;
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(value, Limits::min(), Limits::max()));
}

} // namespace

std::optional<PixelFormat> format_of(std::uint32_t fourcc) noexcept
{
    if (fourcc == V4L2_PIX_FMT_JPEG)
        return PixelFormat::kMjpeg;
    const auto known = std::ranges::find(kFormats, fourcc, [](const auto& pair) { return pair.first; });
    return known == kFormats.end() ? std::nullopt : std::optional{known->second};
}

std::uint32_t fourcc_of(PixelFormat format) noexcept
{
    const auto known = std::ranges::find(kFormats, format, [](const auto& pair) { return pair.second; });
    return known == kFormats.end() ? 0 : known->first;
}

std::uint32_t interval_of(const v4l2_fract& seconds) noexcept
{
    if (seconds.denominator == 0)
        return 0;
    const std::uint64_t interval =
        (std::uint64_t{seconds.numerator} * 10'000'000 + seconds.denominator / 2) / seconds.denominator;
    return interval > std::numeric_limits<std::uint32_t>::max() ? 0 : static_cast<std::uint32_t>(interval);
}

v4l2_fract fraction_of(std::uint32_t interval_100ns) noexcept
{
    return {interval_100ns, 10'000'000};
}

std::uint32_t kernel_id(ControlId id) noexcept
{
    return kIds[static_cast<std::size_t>(id)];
}

std::int32_t to_kernel(ControlId id, std::int32_t value) noexcept
{
    if (id != ControlId::kExposureAuto)
        return value;
    const auto* mode = std::ranges::find(kExposureModes, value, &ExposureMode::uvc);
    return mode == kExposureModes.end() ? -1 : mode->kernel;
}

std::int32_t from_kernel(ControlId id, std::int32_t value) noexcept
{
    if (id != ControlId::kExposureAuto)
        return value;
    const auto* mode = std::ranges::find(kExposureModes, value, &ExposureMode::kernel);
    return mode == kExposureModes.end() ? 0 : mode->uvc;
}

std::optional<ControlRange> range_of(ControlId id, const v4l2_query_ext_ctrl& told) noexcept
{
    constexpr std::uint32_t kUnreadable = V4L2_CTRL_FLAG_DISABLED | V4L2_CTRL_FLAG_WRITE_ONLY;
    const bool number =
        told.type == V4L2_CTRL_TYPE_INTEGER || told.type == V4L2_CTRL_TYPE_BOOLEAN || told.type == V4L2_CTRL_TYPE_MENU;
    if (!number || (told.flags & kUnreadable) != 0)
        return std::nullopt;
    if (id == ControlId::kExposureAuto)
        return ControlRange{id, 1, 8, 1, from_kernel(id, held(told.default_value))};
    const std::uint64_t step = std::clamp<std::uint64_t>(told.step, 1, std::numeric_limits<std::int32_t>::max());
    return ControlRange{id, held(told.minimum), held(std::max(told.minimum, told.maximum)),
                        static_cast<std::int32_t>(step), held(told.default_value)};
}

} // namespace dicot::v4l2
