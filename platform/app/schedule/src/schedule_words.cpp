#include "dicot/schedule/schedule_words.h"

#include <algorithm>

namespace dicot::app {
namespace {

constexpr int kHourS = 3600;
constexpr int kMinuteS = 60;
constexpr int kDayS = 24 * kHourS;
constexpr int kFarthestFromSunS = 12 * kHourS;
constexpr std::size_t kMostWord = 15;     // Slot::why
constexpr std::size_t kMostDuration = 6;  // "23h59m"
constexpr std::size_t kMostZoneText = 63; // TimeZone::name()

bool is_digit(char c) noexcept
{
    return c >= '0' && c <= '9';
}

bool take(std::string_view& text, std::string_view word) noexcept
{
    const bool here = text.starts_with(word);
    text.remove_prefix(here ? word.size() : 0);
    return here;
}

/// Digits, and the letter of their unit behind them.
std::optional<int> take_count(std::string_view& text, char unit) noexcept
{
    const auto digits = static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin());
    if (digits == 0 || digits == text.size() || text[digits] != unit)
        return std::nullopt;
    int count = 0;
    for (const char digit : text.substr(0, digits))
        count = 10 * count + (digit - '0');
    text.remove_prefix(digits + 1);
    return count;
}

} // namespace

std::optional<int> parse_duration_s(std::string_view text) noexcept
{
    if (text.size() > kMostDuration)
        return std::nullopt;
    const std::optional<int> hours = take_count(text, 'h');
    const std::optional<int> minutes = take_count(text, 'm');
    const bool one_way = !hours || !minutes || *minutes < 60; // 90m or 1h30m, not 0h90m
    const int seconds = hours.value_or(0) * kHourS + minutes.value_or(0) * kMinuteS;
    if (!text.empty() || (!hours && !minutes) || !one_way || seconds > kDayS)
        return std::nullopt;
    return seconds;
}

std::optional<int> parse_clock_s(std::string_view text) noexcept
{
    constexpr std::string_view kShape = "00:00";
    if (!std::ranges::equal(text, kShape, [](char c, char shape) { return shape == '0' ? is_digit(c) : c == shape; }))
        return std::nullopt;
    const int hours = 10 * (text[0] - '0') + (text[1] - '0');
    const int minutes = 10 * (text[3] - '0') + (text[4] - '0');
    const int seconds = hours * kHourS + minutes * kMinuteS;
    return minutes < 60 && seconds <= kDayS ? std::optional{seconds} : std::nullopt;
}

std::optional<Moment> parse_moment(std::string_view text) noexcept
{
    if (text.size() > kMostWord)
        return std::nullopt;
    if (const std::optional<int> clock = parse_clock_s(text); clock && *clock < kDayS)
        return Moment{Moment::After::kMidnight, *clock};
    Moment moment;
    if (take(text, "sunrise"))
        moment.after = Moment::After::kSunrise;
    else if (take(text, "sunset"))
        moment.after = Moment::After::kSunset;
    else
        return std::nullopt;
    if (text.empty())
        return moment;
    const int sign = text.front() == '-' ? -1 : 1;
    const std::optional<int> distance = take(text, "+") || take(text, "-") ? parse_duration_s(text) : std::nullopt;
    if (!distance || *distance > kFarthestFromSunS)
        return std::nullopt;
    moment.seconds = sign * *distance;
    return moment;
}

bool is_interval(std::string_view text) noexcept
{
    return text.empty() || parse_duration_s(text).value_or(0) >= kMinuteS;
}

bool is_zone_text(std::string_view text) noexcept
{
    static constexpr std::string_view kMarks = "/_+-,.:<>";
    const auto may_stand = [](char c) {
        return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               kMarks.find(c) != std::string_view::npos;
    };
    return text.size() <= kMostZoneText && std::ranges::all_of(text, may_stand);
}

} // namespace dicot::app
