#include "dicot/base/utc_time.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>

namespace dicot {
namespace {

constexpr std::string_view kTextShape = "0000-00-00T00:00:00Z";
constexpr std::string_view kStampShape = "00000000T000000Z";
constexpr std::int64_t kSecondUs = 1'000'000;
constexpr std::int64_t kDaySeconds = 86'400;

struct Civil
{
    int year, month, day, hour, minute, second;
};

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

bool has_shape(std::string_view text, std::string_view shape)
{
    if (text.size() < shape.size())
        return false;
    for (std::size_t i = 0; i < shape.size(); ++i)
        if (shape[i] == '0' ? !is_digit(text[i]) : text[i] != shape[i])
            return false;
    return true;
}

bool is_leap(int year)
{
    return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
}

int days_in(int year, int month)
{
    if (month == 2)
        return is_leap(year) ? 29 : 28;
    return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
}

/// Days from 1970-01-01 to the first of January of `year`, 0 .. 10000.
std::int64_t days_before_year(int year)
{
    const std::int64_t y = year;
    const std::int64_t leap_days = year == 0 ? 0 : (y - 1) / 4 - (y - 1) / 100 + (y - 1) / 400 + 1; // year 0 is one
    return y * 365 + leap_days - 719'528;
}

std::int64_t days_of(int year, int month, int day)
{
    std::int64_t days = days_before_year(year) + day - 1;
    for (int m = 1; m < month; ++m)
        days += days_in(year, m);
    return days;
}

Civil civil_of(std::int64_t us)
{
    us = std::clamp(us, kFirstUtcUs, kLastUtcUs);
    const std::int64_t since_0000 = (us - kFirstUtcUs) / kSecondUs;
    const std::int64_t day_number = since_0000 / kDaySeconds + kFirstUtcUs / kSecondUs / kDaySeconds;
    const auto in_day = static_cast<int>(since_0000 % kDaySeconds);
    int year = static_cast<int>(since_0000 / kDaySeconds / 366);
    while (days_before_year(year + 1) <= day_number)
        ++year;
    auto day = static_cast<int>(day_number - days_before_year(year));
    int month = 1;
    for (; day >= days_in(year, month); ++month)
        day -= days_in(year, month);
    return {year, month, day + 1, in_day / 3600, in_day / 60 % 60, in_day % 60};
}

/// Reads the digits of `text`, whatever stands between them.
std::optional<std::int64_t> time_of(std::string_view text)
{
    constexpr int kDigits[] = {4, 2, 2, 2, 2, 2};
    int numbers[6] = {};
    std::size_t at = 0;
    for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < kDigits[i]; ++at)
            if (is_digit(text[at])) {
                numbers[i] = 10 * numbers[i] + (text[at] - '0');
                ++k;
            }
    }
    const auto [year, month, day, hour, minute, second] = numbers;
    if (month < 1 || month > 12 || day < 1 || day > days_in(year, month) || hour > 23 || minute > 59 || second > 59)
        return {};
    return (days_of(year, month, day) * kDaySeconds + hour * 3600 + minute * 60 + second) * kSecondUs;
}

template <typename... Numbers>
UtcText printed(const char* format, Numbers... numbers)
{
    char text[UtcText::kCapacity + 1];
    const int length = std::snprintf(text, sizeof text, format, numbers...);
    return std::string_view{text, static_cast<std::size_t>(std::clamp(length, 0, static_cast<int>(sizeof text) - 1))};
}

} // namespace

UtcText utc_text(std::int64_t us) noexcept
{
    const Civil at = civil_of(us);
    return printed("%04d-%02d-%02dT%02d:%02d:%02dZ", at.year, at.month, at.day, at.hour, at.minute, at.second);
}

UtcText utc_stamp(std::int64_t us) noexcept
{
    const Civil at = civil_of(us);
    return printed("%04d%02d%02dT%02d%02d%02dZ", at.year, at.month, at.day, at.hour, at.minute, at.second);
}

UtcText utc_day(std::int64_t us) noexcept
{
    const Civil at = civil_of(us);
    return printed("%04d-%02d-%02d", at.year, at.month, at.day);
}

std::optional<std::int64_t> parse_utc_text(std::string_view text) noexcept
{
    return text.size() == kTextShape.size() && has_shape(text, kTextShape) ? time_of(text) : std::nullopt;
}

std::optional<std::int64_t> parse_utc_stamp(std::string_view text) noexcept
{
    return text.size() == kStampShape.size() && has_shape(text, kStampShape) ? time_of(text) : std::nullopt;
}

bool begins_as_utc_time(std::string_view text) noexcept
{
    return has_shape(text, kTextShape.substr(0, 5));
}

} // namespace dicot
