#include "utc_time.h"

#include <cstddef>

namespace dicot {
namespace {

constexpr std::string_view kShape = "0000-00-00T00:00:00Z";

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

int number_in(std::string_view text, std::size_t from, std::size_t count)
{
    int number = 0;
    for (const char c : text.substr(from, count))
        number = 10 * number + (c - '0');
    return number;
}

int days_in(int year, int month)
{
    if (month == 2)
        return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) ? 29 : 28;
    return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
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

} // namespace

bool is_utc_time(std::string_view text)
{
    if (text.size() != kShape.size() || !has_shape(text, kShape))
        return false;
    const int month = number_in(text, 5, 2);
    const int day = number_in(text, 8, 2);
    return month >= 1 && month <= 12 && day >= 1 && day <= days_in(number_in(text, 0, 4), month) &&
           number_in(text, 11, 2) < 24 && number_in(text, 14, 2) < 60 && number_in(text, 17, 2) < 60;
}

bool begins_as_utc_time(std::string_view text)
{
    return has_shape(text, kShape.substr(0, 5));
}

} // namespace dicot
