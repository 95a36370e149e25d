// Pictures of noise as files: something to match where only the program's manners matter.
#pragma once

#include "temp_folder.h"

#include <random>
#include <string>

namespace dicot::test {

inline Bytes noise_ppm(int width, int height, unsigned seed)
{
    const std::string head = "P6 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
    Bytes file(head.begin(), head.end());
    std::mt19937 random{seed};
    for (int i = 0; i < width * height * 3; ++i)
        file.push_back(static_cast<std::uint8_t>(random()));
    return file;
}

} // namespace dicot::test
