#include "zone_rule.h"

#include <algorithm>
#include <array>
#include <chrono>

namespace dicot {
namespace {

constexpr int kFirstYear = 1969; // what held as 1970 began
constexpr int kLastYear = 2100;
constexpr int kMostRuleHours = 167; // RFC 8536, 3.3.1; POSIX alone has 24
constexpr int kMostOffsetHours = 24;

/// What is left of a rule, from front to back.
struct Rest
{
    std::string_view text;

    bool take(char c) noexcept
    {
        const bool here = text.starts_with(c);
        text.remove_prefix(here ? 1 : 0);
        return here;
    }

    std::optional<int> number(int least, int most) noexcept
    {
        constexpr std::size_t kMostDigits = 3;
        int value = 0;
        std::size_t digits = 0;
        for (; digits < std::min(text.size(), kMostDigits) && text[digits] >= '0' && text[digits] <= '9'; ++digits)
            value = 10 * value + (text[digits] - '0');
        text.remove_prefix(digits);
        return digits > 0 && value >= least && value <= most ? std::optional{value} : std::nullopt;
    }

    /// Three letters or more, or "<+0545>".
    bool name() noexcept
    {
        const bool framed = take('<');
        const auto belongs = [framed](char c) {
            const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
            return letter || (framed && ((c >= '0' && c <= '9') || c == '+' || c == '-'));
        };
        const auto length = static_cast<std::size_t>(std::ranges::find_if_not(text, belongs) - text.begin());
        text.remove_prefix(length);
        return length >= 3 && (!framed || take('>'));
    }

    /// "[+-]h[:mm[:ss]]" in seconds.
    std::optional<int> time_s(int most_hours) noexcept
    {
        const bool minus = take('-');
        if (!minus)
            (void)take('+');
        int seconds = 0;
        for (int unit = 3600; unit >= 1 && (unit == 3600 || take(':')); unit /= 60) {
            const std::optional<int> part = number(0, unit == 3600 ? most_hours : 59);
            if (!part)
                return std::nullopt;
            seconds += *part * unit;
        }
        return minus ? -seconds : seconds;
    }

    std::optional<RuleDate> date() noexcept
    {
        RuleDate date;
        std::optional<int> day;
        if (take('M')) {
            date.kind = RuleDate::Kind::kWeekday;
            const std::optional<int> month = number(1, 12);
            const std::optional<int> week = take('.') ? number(1, 5) : std::nullopt;
            day = take('.') ? number(0, 6) : std::nullopt;
            if (!month || !week)
                return std::nullopt;
            date.month = *month;
            date.week = *week;
        } else if (take('J')) {
            date.kind = RuleDate::Kind::kWithoutLeapDay;
            day = number(1, 365);
        } else {
            day = number(0, 365);
        }
        const std::optional<int> time = take('/') ? time_s(kMostRuleHours) : std::optional{date.time_s};
        if (!day || !time)
            return std::nullopt;
        date.day = *day;
        date.time_s = *time;
        return date;
    }
};

/// Local seconds since 1970.
std::int64_t seconds_of(const RuleDate& date, std::chrono::year year) noexcept
{
    using namespace std::chrono;
    sys_days day;
    if (date.kind == RuleDate::Kind::kWeekday) {
        const auto month_of = year / month{static_cast<unsigned>(date.month)};
        const weekday on{static_cast<unsigned>(date.day)};
        day =
            date.week == 5 ? sys_days{month_of / on[last]} : sys_days{month_of / on[static_cast<unsigned>(date.week)]};
    } else {
        day = sys_days{year / January / 1} + days{date.day};
        if (date.kind == RuleDate::Kind::kWithoutLeapDay)
            day += days{date.day >= 60 && year.is_leap() ? 0 : -1};
    }
    return std::int64_t{day.time_since_epoch().count()} * 86'400 + date.time_s;
}

} // namespace

std::optional<ZoneRule> parse_zone_rule(std::string_view text) noexcept
{
    Rest rest{text};
    ZoneRule rule;
    const std::optional<int> west = rest.name() ? rest.time_s(kMostOffsetHours) : std::nullopt;
    if (!west)
        return std::nullopt;
    rule.offset_s = -*west;
    if (rest.text.empty())
        return rule;
    if (!rest.name())
        return std::nullopt;
    const bool plain = rest.text.starts_with(',');
    const std::optional<int> summer_west = plain ? std::optional{*west - 3600} : rest.time_s(kMostOffsetHours);
    const std::optional<RuleDate> start = rest.take(',') ? rest.date() : std::nullopt;
    const std::optional<RuleDate> end = rest.take(',') ? rest.date() : std::nullopt;
    if (!summer_west || !start || !end || !rest.text.empty())
        return std::nullopt;
    rule.summer = ZoneRule::Summer{-*summer_west, *start, *end};
    return rule;
}

bool append_rule(const ZoneRule& rule, std::int64_t after_s, ZoneTable& table) noexcept
{
    if (table.changes == 0 && after_s == kNoChangeYet)
        table.offset_s[0] = rule.offset_s;
    if (!rule.summer)
        return true;
    struct Change
    {
        std::int64_t at_s;
        int order; // of the same second the later one holds: summer that ends as the next begins does not end
        std::int32_t offset_s;
    };
    std::array<Change, 2 * (kLastYear - kFirstYear + 1)> all;
    std::size_t count = 0;
    for (int year = kFirstYear; year <= kLastYear; ++year) {
        const std::chrono::year y{year};
        const int order = 2 * year;
        all[count++] = {seconds_of(rule.summer->start, y) - rule.offset_s, order + 1, rule.summer->offset_s};
        all[count++] = {seconds_of(rule.summer->end, y) - rule.summer->offset_s, order, rule.offset_s};
    }
    std::ranges::sort(
        all, [](const Change& a, const Change& b) { return a.at_s != b.at_s ? a.at_s < b.at_s : a.order < b.order; });
    return std::ranges::all_of(all, [&](const Change& change) {
        return change.at_s <= after_s || table.change(change.at_s, change.offset_s);
    });
}

} // namespace dicot
