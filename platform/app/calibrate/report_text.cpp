#include "report_text.h"

#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace dicot::app {
namespace {

constexpr std::string_view kNoCharacter = "\xEF\xBF\xBD"; // U+FFFD

/// Bytes of the UTF-8 sequence that begins the text; 0 when none does (Unicode 15, table 3-7).
std::size_t sequence_bytes(std::string_view text)
{
    const auto at = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
    const unsigned first = at(0);
    if (first < 0x80)
        return 1;
    const std::size_t count = first >= 0xC2 && first <= 0xDF   ? 2
                              : first >= 0xE0 && first <= 0xEF ? 3
                              : first >= 0xF0 && first <= 0xF4 ? 4
                                                               : 0;
    for (std::size_t k = 1; k < count; ++k)
        if (at(k) < 0x80 || at(k) > 0xBF)
            return 0;
    const bool overlong = (first == 0xE0 && at(1) < 0xA0) || (first == 0xF0 && at(1) < 0x90);
    const bool surrogate = first == 0xED && at(1) > 0x9F;
    const bool beyond = first == 0xF4 && at(1) > 0x8F;
    const bool no_character = first == 0xEF && at(1) == 0xBF && at(2) >= 0xBE; // U+FFFE, U+FFFF
    return overlong || surrogate || beyond || no_character ? 0 : count;
}

} // namespace

std::string escaped(std::string_view text)
{
    std::string safe;
    while (!text.empty()) {
        const std::size_t count = sequence_bytes(text);
        const char c = text.front();
        if (count == 0)
            safe += kNoCharacter;
        else if (count > 1)
            safe += text.substr(0, count);
        else if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '>')
            safe += "&gt;";
        else if (c == '"')
            safe += "&quot;";
        else if (c == '\'')
            safe += "&#39;";
        else if (c == '\n' || c == '\r' || c == '\t')
            safe += ' ';
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
            safe += kNoCharacter;
        else
            safe += c;
        text.remove_prefix(count == 0 ? 1 : count);
    }
    return safe;
}

std::string fixed(double value, int decimals)
{
    constexpr double kMost = 1e15; // so that the digits below always fit
    if (!std::isfinite(value) || std::abs(value) > kMost)
        return "unknown";
    std::array<char, 64> digits; // to_chars, not printf: a locale must not turn the point into a comma
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, decimals);
    const std::string_view number(digits.data(), static_cast<std::size_t>(end.ptr - digits.data()));
    const bool zero = number.find_first_not_of("-0.") == std::string_view::npos;
    return std::string(zero && number.front() == '-' ? number.substr(1) : number);
}

std::string fill(std::string_view pattern, std::initializer_list<Piece> pieces)
{
    std::string whole;
    const Piece* next = pieces.begin();
    for (std::size_t hole = pattern.find("{}"); hole != std::string_view::npos; hole = pattern.find("{}")) {
        assert(next != pieces.end());
        whole += pattern.substr(0, hole);
        whole += next++->text();
        pattern.remove_prefix(hole + 2);
    }
    assert(next == pieces.end());
    whole += pattern;
    return whole;
}

} // namespace dicot::app
