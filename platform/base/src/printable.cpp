#include "dicot/base/printable.h"

#include <algorithm>
#include <cstdint>

namespace dicot {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

struct Character
{
    std::size_t bytes; ///< that belong together; 1 at least
    bool printable;
};

bool is_shown(std::uint32_t point)
{
    const bool control = point < 0x20 || (point >= 0x7F && point < 0xA0);
    const bool line_or_direction = point == 0x061C || point == 0x200E || point == 0x200F ||
                                   (point >= 0x2028 && point <= 0x202E) || (point >= 0x2066 && point <= 0x2069);
    return !control && !line_or_direction;
}

/// The first one of a text that is not empty.
Character first_of(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint8_t lead = byte(0);
    if (lead < 0x80)
        return {1, is_shown(lead)};
    if (lead < 0xC2 || lead > 0xF4)
        return {1, false};
    const std::size_t length = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    std::uint32_t point = lead & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        // The second byte's range keeps out what is too long, surrogates and what lies beyond U+10FFFF.
        const std::uint8_t least = i > 1 ? 0x80 : lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
        const std::uint8_t most = i > 1 ? 0xBF : lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
        if (i == text.size() || byte(i) < least || byte(i) > most)
            return {i, false};
        point = point << 6 | (byte(i) & 0x3FU);
    }
    return {length, is_shown(point)};
}

} // namespace

bool is_printable(std::string_view text) noexcept
{
    while (!text.empty()) {
        const Character first = first_of(text);
        if (!first.printable)
            return false;
        text.remove_prefix(first.bytes);
    }
    return true;
}

std::size_t printable_into(std::string_view text, std::span<char> into) noexcept
{
    std::size_t size = 0;
    while (!text.empty()) {
        const Character first = first_of(text);
        const std::string_view shown = first.printable ? text.substr(0, first.bytes) : kReplacement;
        if (shown.size() > into.size() - size)
            break;
        std::copy(shown.begin(), shown.end(), into.data() + size);
        size += shown.size();
        text.remove_prefix(first.bytes);
    }
    return size;
}

} // namespace dicot
