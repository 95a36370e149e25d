// What the name of a picture says: which side, and which pair.
#pragma once

#include <string>
#include <string_view>

namespace dicot::app {

enum class Side
{
    kNone,
    kLeft,
    kRight,
    kBoth ///< it says left and right
};

enum class CameraNumbers
{
    kFromZero, ///< cam0 is left, cam1 right
    kFromOne   ///< cam1 is left, cam2 right
};

/// Whether the name has the word `cam` or `camera` before the number, e.g. cam0.
bool names_camera(std::string_view name, int number);

struct PictureName
{
    Side side = Side::kNone;
    std::string spelling; ///< lower case, the words for the side replaced by a mark, without the ending
    std::string number;   ///< the same without leading zeros: equal for both pictures of a pair
    int ending = 0;       ///< PNG before PPM before JPEG
};

/// Reads a name; `name` ends as is_picture() wants it.
PictureName read_name(std::string_view name, CameraNumbers numbers);

/// Whether the ending is one of PNG's, JPEG's or PPM's.
bool is_picture(std::string_view name);

/// Runs of digits by their value, all else by its letters: 2 before 10. A strict order of all strings.
bool before(std::string_view a, std::string_view b);

} // namespace dicot::app
