#include "shown.h"

#include <array>
#include <cstdio>

namespace dicot::app {

std::string shown(std::string_view text)
{
    constexpr std::size_t kMost = 200;
    constexpr const char* kHex = "0123456789ABCDEF";
    std::string printable;
    for (const char c : text.substr(0, kMost)) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\\')
            printable += "\\\\";
        else if (c >= ' ' && c <= '~')
            printable += c;
        else
            printable += {'\\', 'x', kHex[byte >> 4U], kHex[byte & 15U]};
    }
    return text.size() > kMost ? printable + "..." : printable;
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
