#include "words.h"

#include <array>
#include <cstdarg>
#include <cstdio>

namespace dicot::calibration {

std::string text(const char* format, ...)
{
    std::array<char, 300> buffer{};
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(buffer.data(), buffer.size(), format, arguments);
    va_end(arguments);
    return buffer.data();
}

} // namespace dicot::calibration
