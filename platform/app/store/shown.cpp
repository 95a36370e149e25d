#include "shown.h"

#include "dicot/base/printable.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace dicot::app {

namespace {

constexpr std::size_t kMost = 255;

bool is_continued(char c)
{
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// How many bytes of the text are shown.
std::size_t whole_characters(std::string_view text)
{
    std::size_t size = std::min(text.size(), kMost);
    for (int back = 0; back < 3 && size < text.size() && is_continued(text[size]); ++back)
        --size;
    return size;
}

/// As many bytes as its first one promises.
std::size_t bytes_of_character(char lead)
{
    const auto byte = static_cast<unsigned char>(lead);
    return byte < 0xC0 ? 1 : byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : 4;
}

} // namespace

std::string shown(std::string_view text)
{
    constexpr const char* kHex = "0123456789ABCDEF";
    const std::string_view part = text.substr(0, whole_characters(text));
    const char* const end = part.size() < text.size() ? "..." : "";
    if (is_printable(part))
        return std::string{part} + end;
    std::string escaped;
    for (std::size_t i = 0; i < part.size();) {
        const std::string_view character = part.substr(i, bytes_of_character(part[i]));
        const auto byte = static_cast<unsigned char>(part[i]);
        if (part[i] == '\\') {
            escaped += "\\\\";
        } else if (is_printable(character)) {
            escaped += character;
            i += character.size();
            continue;
        } else {
            escaped += {'\\', 'x', kHex[byte >> 4U], kHex[byte & 15U]};
        }
        ++i;
    }
    return escaped + end;
}

std::string shown_bytes(double bytes)
{
    constexpr std::array kUnits{"B", "KiB", "MiB", "GiB", "TiB"};
    std::size_t unit = 0;
    for (; bytes >= 1024 && unit + 1 < kUnits.size(); ++unit)
        bytes /= 1024;
    char text[40];
    std::snprintf(text, sizeof text, unit == 0 ? "%.0f %s" : "%.1f %s", bytes, kUnits[unit]);
    return text;
}

std::string counted(std::int64_t count, const char* what)
{
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

} // namespace dicot::app
