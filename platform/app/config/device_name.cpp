#include "device_name.h"

#include <algorithm>

namespace dicot::app {
namespace {

constexpr std::size_t kMostLetters = 63;

bool is_digit(char c) noexcept
{
    return c >= '0' && c <= '9';
}

bool is_letter_or_digit(char c) noexcept
{
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool may_stand(char c) noexcept
{
    return is_letter_or_digit(c) || c == '.' || c == '_' || c == '-';
}

bool is_date(std::string_view text) noexcept
{
    constexpr std::string_view kShape = "0000-00-00";
    return std::ranges::equal(text, kShape, [](char c, char shape) { return shape == '0' ? is_digit(c) : c == shape; });
}

} // namespace

bool is_device_name(std::string_view text) noexcept
{
    return !text.empty() && text.size() <= kMostLetters && is_letter_or_digit(text.front()) &&
           std::ranges::all_of(text, may_stand) && !is_date(text);
}

std::string device_name_near(std::string_view host)
{
    std::string name{host};
    std::ranges::replace_if(
        name, [](char c) { return !may_stand(c); }, '-');
    name.erase(name.begin(), std::ranges::find_if(name, is_letter_or_digit));
    name.resize(std::min(name.size(), kMostLetters));
    return is_device_name(name) ? name : "dicot";
}

} // namespace dicot::app
