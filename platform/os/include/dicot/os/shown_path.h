// Paths in sentences.
#pragma once

#include <cstring>

namespace dicot {

/// The end of a path: as much of it as leaves room for the rest of a Status's sentence.
inline const char* shown_path(const char* path) noexcept
{
    constexpr std::size_t kShown = 200;
    const std::size_t length = std::strlen(path);
    const char* shown = length > kShown ? path + (length - kShown) : path;
    while ((static_cast<unsigned char>(*shown) & 0xC0U) == 0x80U) // not from the middle of a character of UTF-8
        ++shown;
    return shown;
}

} // namespace dicot
