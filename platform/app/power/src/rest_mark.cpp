#include "dicot/power/rest_mark.h"

#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <cstring>

namespace dicot::app {
namespace {

template <typename Number>
bool take(std::string_view& text, std::string_view before, Number& number) noexcept
{
    if (!text.starts_with(before))
        return false;
    text.remove_prefix(before.size());
    const auto [stopped, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(stopped - text.data()));
    return error == std::errc{};
}

} // namespace

ShortText<200> text_of(const RestMark& mark) noexcept
{
    char words[201];
    std::snprintf(words, sizeof words, "rest slot=%" PRIu64 " due_us=%" PRId64 " alarm_us=%" PRId64 " boot=%s\n",
                  mark.slot, mark.due_us, mark.alarm_us, mark.boot.text);
    return words;
}

std::optional<RestMark> parse_rest_mark(std::string_view text) noexcept
{
    RestMark mark;
    if (!take(text, "rest slot=", mark.slot) || !take(text, " due_us=", mark.due_us) ||
        !take(text, " alarm_us=", mark.alarm_us) || !text.starts_with(" boot=") || !text.ends_with('\n'))
        return std::nullopt;
    text.remove_prefix(6);
    text.remove_suffix(1);
    if (text.size() != sizeof mark.boot.text - 1 ||
        text.find_first_not_of("0123456789abcdef-") != std::string_view::npos)
        return std::nullopt;
    std::memcpy(mark.boot.text, text.data(), text.size());
    return mark;
}

} // namespace dicot::app
