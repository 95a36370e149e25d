#include "meta_entries.h"

#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace dicot {
namespace {

constexpr int kMaxReadableBits = 24; // beyond it float32 does not hold the steps apart
constexpr std::int32_t kMaxStepUm = 100000;
constexpr std::int32_t kMaxOriginSteps = 1 << 24;

template <typename Number>
CloudMeta::Text text_of(Number number)
{
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, number);
    return std::string_view{digits, static_cast<std::size_t>(end.ptr - digits)};
}

/// The whole text is one number.
template <typename Number>
bool number_of(std::string_view text, Number& number)
{
    const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
    return end.ec == std::errc{} && end.ptr == text.data() + text.size();
}

template <typename Number>
bool number_of(std::string_view text, std::optional<Number>& number)
{
    Number value{};
    if (!number_of(text, value) || !std::isfinite(static_cast<double>(value)))
        return false;
    number = value;
    return true;
}

bool printable(std::string_view text)
{
    for (const char c : text)
        if (c < 0x20 || c > 0x7e)
            return false;
    return true;
}

bool text_of(std::string_view text, CloudMeta::Text& into)
{
    if (text.size() > CloudMeta::Text::kCapacity || !printable(text))
        return false;
    into = text;
    return true;
}

CloudMeta::Text origin_text(const CloudGrid& grid)
{
    char text[48];
    char* at = text;
    for (int axis = 0; axis < 3; ++axis) {
        if (axis > 0)
            *at++ = ' ';
        at = std::to_chars(at, text + sizeof text, grid.origin[axis]).ptr;
    }
    return std::string_view{text, static_cast<std::size_t>(at - text)};
}

bool origin_of(std::string_view text, CloudGrid& grid)
{
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t space = axis < 2 ? text.find(' ') : text.size();
        if (space == std::string_view::npos || !number_of(text.substr(0, space), grid.origin[axis]) ||
            grid.origin[axis] < -kMaxOriginSteps || grid.origin[axis] > kMaxOriginSteps)
            return false;
        text.remove_prefix(axis < 2 ? space + 1 : space);
    }
    return true;
}

CloudMeta::Text step_text(const CloudGrid& grid)
{
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, grid.step_um / 1e6, std::chars_format::fixed);
    return std::string_view{digits, static_cast<std::size_t>(end.ptr - digits)};
}

bool step_of(std::string_view text, CloudGrid& grid)
{
    double metres = 0;
    if (!number_of(text, metres) || !(metres >= 1e-6) || !(metres <= kMaxStepUm * 1e-6))
        return false;
    const double um = std::round(metres * 1e6);
    grid.step_um = static_cast<std::int32_t>(um);
    return std::fabs(metres * 1e6 - um) < 1e-6;
}

} // namespace

MetaEntries entries_of(const CloudMeta& meta, const CloudGrid& grid)
{
    MetaEntries all;
    const auto add = [&all](const char* key, const CloudMeta::Text& text) {
        assert(all.count < MetaEntries::kMost);
        if (!text.empty())
            all.entries[all.count++] = {key, text};
    };
    add("unit", kCloudUnit);
    add("frame", kCloudFrame);
    add("quantization_step", step_text(grid));
    add("grid_bits", text_of(grid.bits));
    add("grid_origin", origin_text(grid));
    add("captured_at", meta.captured_at);
    add("clock_trust", meta.clock_trust);
    add("device_id", meta.device_id);
    add("calibration_id", meta.calibration_id);
    add("software", meta.software);
    if (meta.sequence)
        add("sequence", text_of(*meta.sequence));
    if (meta.skew_us)
        add("skew_us", text_of(*meta.skew_us));
    if (meta.near_mm)
        add("near_mm", text_of(*meta.near_mm));
    if (meta.far_mm)
        add("far_mm", text_of(*meta.far_mm));
    return all;
}

unsigned grid_key(std::string_view key)
{
    return key == "unit"                ? kSeenUnit
           : key == "quantization_step" ? kSeenStep
           : key == "grid_bits"         ? kSeenBits
           : key == "grid_origin"       ? kSeenOrigin
                                        : 0U;
}

bool take_entry(std::string_view key, std::string_view text, CloudMeta& meta, CloudGrid& grid)
{
    if (key == "unit")
        return text == kCloudUnit;
    if (key == "frame")
        return text == kCloudFrame;
    if (key == "quantization_step")
        return step_of(text, grid);
    if (key == "grid_bits")
        return number_of(text, grid.bits) && grid.bits >= 1 && grid.bits <= kMaxReadableBits;
    if (key == "grid_origin")
        return origin_of(text, grid);
    if (key == "captured_at")
        return text_of(text, meta.captured_at);
    if (key == "clock_trust")
        return text_of(text, meta.clock_trust);
    if (key == "device_id")
        return text_of(text, meta.device_id);
    if (key == "calibration_id")
        return text_of(text, meta.calibration_id);
    if (key == "software")
        return text_of(text, meta.software);
    if (key == "sequence")
        return number_of(text, meta.sequence);
    if (key == "skew_us")
        return number_of(text, meta.skew_us);
    if (key == "near_mm")
        return number_of(text, meta.near_mm);
    if (key == "far_mm")
        return number_of(text, meta.far_mm);
    return true;
}

} // namespace dicot
