#include "folder_name.h"

#include "dicot/base/utc_time.h"
#include "dicot/store/store.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <string>

namespace dicot {
namespace {

constexpr std::size_t kDigits = 6;

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

bool is_name_character(char c)
{
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '_' || c == '-';
}

} // namespace

ShortText<31> snapshot_name(const SnapshotName& name)
{
    char text[64]; // as much as the types could hold
    std::snprintf(text, sizeof text, "%06" PRId64 "_%s", name.sequence, utc_stamp(name.began_us).c_str());
    return text;
}

std::optional<SnapshotName> parse_snapshot_name(std::string_view text)
{
    const std::size_t digits = std::min(text.find('_'), text.size());
    if (digits < kDigits || digits > 9 || (digits > kDigits && text[0] == '0') ||
        !std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(digits), is_digit))
        return {};
    SnapshotName name;
    for (const char c : text.substr(0, digits))
        name.sequence = 10 * name.sequence + (c - '0');
    const std::optional<std::int64_t> began =
        digits < text.size() ? parse_utc_stamp(text.substr(digits + 1)) : std::nullopt;
    if (name.sequence < 1 || !began)
        return {};
    name.began_us = *began;
    return name;
}

ShortText<63> part_name(const PartName& part)
{
    const ShortText<31> name = snapshot_name(part.name);
    if (!part.due_us)
        return name.view();
    char text[64];
    std::snprintf(text, sizeof text, "%s_%s", name.c_str(), utc_stamp(*part.due_us).c_str());
    return text;
}

std::optional<PartName> parse_part_name(std::string_view text)
{
    if (const auto name = parse_snapshot_name(text))
        return PartName{*name, {}};
    const std::size_t cut = text.rfind('_');
    if (cut == std::string_view::npos)
        return {};
    const auto name = parse_snapshot_name(text.substr(0, cut));
    const auto due = parse_utc_stamp(text.substr(cut + 1));
    if (!name || !due)
        return {};
    return PartName{*name, due};
}

bool is_day_name(std::string_view text)
{
    constexpr std::size_t kDayLength = 10;
    if (text.size() != kDayLength)
        return false;
    char time[32];
    std::snprintf(time, sizeof time, "%.10sT00:00:00Z", text.data());
    return is_utc_time(time);
}

bool is_file_name(std::string_view text)
{
    return !text.empty() && text.size() <= 31 && text[0] != '.' &&
           std::all_of(text.begin(), text.end(), is_name_character);
}

StorePath join(std::string_view a, std::string_view b)
{
    char text[StorePath::kCapacity + 1];
    const char* const between = a.empty() ? "" : "/";
    const int length = std::snprintf(text, sizeof text, "%.*s%s%.*s", static_cast<int>(a.size()), a.data(), between,
                                     static_cast<int>(b.size()), b.data());
    return std::string_view{text, static_cast<std::size_t>(std::clamp(length, 0, static_cast<int>(sizeof text) - 1))};
}

SlotRow row_named(const SnapshotName& name)
{
    SlotRow row;
    row.sequence = name.sequence;
    row.began_us = name.began_us;
    return row;
}

StorePath folder_of(const SlotRow& row)
{
    return folder_of(row.sequence, row.began_us).view();
}

ShortText<63> folder_of(std::int64_t sequence, std::int64_t began_us)
{
    return join(utc_day(began_us).view(), snapshot_name({sequence, began_us}).view()).view();
}

} // namespace dicot
