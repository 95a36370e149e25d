#include "dicot/os/time_zone.h"

#include "dicot/os/input_file.h"
#include "dicot/os/shown_path.h"

#include "zone_file.h"
#include "zone_rule.h"

#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstdio>

namespace dicot {
namespace {

constexpr std::int64_t kSecondUs = 1'000'000;
constexpr std::int64_t kDayS = 86'400;
constexpr std::size_t kMostFileBytes = std::size_t{16} * 1024; // the largest has 4

constexpr std::int64_t rounded_down(std::int64_t value, std::int64_t unit) noexcept
{
    return value / unit - (value % unit < 0 ? 1 : 0);
}

Status read_table(const char* path, ZoneTable& table) noexcept
{
    InputFile file;
    TRY(file.open(path));
    std::array<std::byte, kMostFileBytes + 1> bytes;
    const std::size_t count = TRY(file.read(bytes));
    const char* wrong =
        count > kMostFileBytes ? "is no zone file" : read_zone_file(std::span{bytes}.first(count), table);
    return wrong == nullptr ? Status{} : failure(Fault::kConfig, "%s: the zone file %s", shown_path(path), wrong);
}

/// Such a name leads to a file below the folder of zones, if it leads anywhere.
bool is_zone_name(std::string_view name) noexcept
{
    const auto belongs = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '/' || c == '_' ||
               c == '-' || c == '+';
    };
    return !name.empty() && name.front() != '/' && std::ranges::all_of(name, belongs);
}

/// What the link at `local_file` calls the zone.
ShortText<63> name_of_local(const char* local_file) noexcept
{
    constexpr std::string_view kFolder = "/zoneinfo/";
    char target[PATH_MAX];
    const ::ssize_t length = ::readlink(local_file, target, sizeof target);
    const std::string_view path{target, length > 0 ? static_cast<std::size_t>(length) : 0};
    const std::size_t at = path.rfind(kFolder);
    return at == std::string_view::npos ? "local time" : path.substr(at + kFolder.size());
}

} // namespace

bool ZoneTable::change(std::int64_t at_s, std::int32_t to_offset_s) noexcept
{
    if (changes > 0 && from_s[static_cast<std::size_t>(changes) - 1] == at_s)
        --changes;
    const auto count = static_cast<std::size_t>(changes);
    if (offset_s[count] == to_offset_s)
        return true;
    if (changes == kMostChanges || (changes > 0 && at_s < from_s[count - 1]))
        return false;
    from_s[count] = at_s;
    offset_s[count + 1] = to_offset_s;
    ++changes;
    return true;
}

Result<TimeZone> TimeZone::open(std::string_view name, const char* folder, const char* local_file) noexcept
{
    TimeZone zone;
    if (name.empty()) {
        if (::access(local_file, F_OK) != 0)
            return zone;
        zone.name_ = name_of_local(local_file);
        const Status read = read_table(local_file, zone.table_);
        return read.ok() ? Result{zone} : failure(Fault::kConfig, "%s", read.message());
    }
    zone.name_ = name;
    if (name == "UTC") // also where there is no database
        return zone;
    char path[PATH_MAX];
    std::snprintf(path, sizeof path, "%s/%s", folder, zone.name_.c_str());
    if (zone.name_.view() == name && is_zone_name(name) && ::access(path, F_OK) == 0) {
        const Status read = read_table(path, zone.table_);
        return read.ok() ? Result{zone} : failure(Fault::kConfig, "%s", read.message());
    }
    const std::optional<ZoneRule> rule = parse_zone_rule(name);
    if (!rule)
        return failure(Fault::kConfig,
                       "there is no time zone \"%s\": give a name of the IANA database, as Europe/Berlin (%s lists "
                       "them, of the package tzdata), or a whole rule, as CET-1CEST,M3.5.0,M10.5.0/3",
                       zone.name_.c_str(), folder);
    if (!append_rule(*rule, kNoChangeYet, zone.table_))
        return failure(Fault::kSoftware, "the rule of the time zone \"%s\" has more changes than dicot keeps",
                       zone.name_.c_str());
    return zone;
}

int TimeZone::offset_s(std::int64_t utc_us) const noexcept
{
    const auto begin = table_.from_s.begin();
    const auto first_later = std::upper_bound(begin, begin + table_.changes, rounded_down(utc_us, kSecondUs));
    return table_.offset_s[static_cast<std::size_t>(first_later - begin)];
}

std::int64_t TimeZone::local_us(std::int64_t utc_us) const noexcept
{
    return utc_us + offset_s(utc_us) * kSecondUs;
}

std::int64_t TimeZone::utc_us(std::int64_t local_day, int in_day_s) const noexcept
{
    constexpr std::int64_t kFarthestS = 2 * kDayS; // further than any offset
    const std::int64_t local_s = local_day * kDayS + in_day_s;
    const auto begin = table_.from_s.begin();
    auto period =
        static_cast<std::size_t>(std::upper_bound(begin, begin + table_.changes, local_s - kFarthestS) - begin);
    const auto changes = static_cast<std::size_t>(table_.changes);
    while (period < changes && local_s >= table_.from_s[period] + table_.offset_s[period])
        ++period;
    // The first period that ends behind this local time; it begins behind it too if that lies in a gap.
    const bool in_gap = period > 0 && local_s < table_.from_s[period - 1] + table_.offset_s[period];
    return (local_s - table_.offset_s[period - (in_gap ? 1 : 0)]) * kSecondUs;
}

std::int64_t TimeZone::local_day(std::int64_t utc_us) const noexcept
{
    return rounded_down(local_us(utc_us), kDayS * kSecondUs);
}

ShortText<9> offset_text(int offset_s) noexcept
{
    const int size = offset_s < 0 ? -offset_s : offset_s;
    char text[32];
    int length = std::snprintf(text, sizeof text, "%c%02d:%02d", offset_s < 0 ? '-' : '+', size / 3600, size / 60 % 60);
    if (size % 60 != 0)
        length += std::snprintf(text + length, sizeof text - static_cast<std::size_t>(length), ":%02d", size % 60);
    return std::string_view{text, static_cast<std::size_t>(length)};
}

} // namespace dicot
