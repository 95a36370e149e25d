#include "shown.h"

#include "dicot/base/printable.h"

#include <array>
#include <cstdio>

namespace dicot::app {

std::string shown(std::string_view text)
{
    constexpr std::size_t kMost = 200;
    constexpr const char* kHex = "0123456789ABCDEF";
    if (text.size() <= kMost && is_printable(text))
        return std::string{text};
    std::string escaped;
    for (const char c : text.substr(0, kMost)) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\\')
            escaped += "\\\\";
        else if (c >= ' ' && c <= '~')
            escaped += c;
        else
            escaped += {'\\', 'x', kHex[byte >> 4U], kHex[byte & 15U]};
    }
    return text.size() > kMost ? escaped + "..." : escaped;
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
