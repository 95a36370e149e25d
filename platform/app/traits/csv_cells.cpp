#include "csv_cells.h"

#include "../store/shown.h"

#include <charconv>
#include <cmath>

namespace dicot::app {

std::string csv_cell(double value)
{
    if (!std::isfinite(value))
        return "";
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr;
    return {text, end};
}

std::string csv_cell(const std::string& text)
{
    const std::string words = shown(text);
    const std::string plain = (words.find_first_of("=+-@") == 0 ? "'" : "") + words;
    if (plain.find_first_of(",\"") == std::string::npos)
        return plain;
    std::string quoted = "\"";
    for (const char c : plain)
        quoted += c == '"' ? std::string{"\"\""} : std::string{c};
    return quoted + "\"";
}

} // namespace dicot::app
