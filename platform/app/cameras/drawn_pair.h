// A pair of pictures that the program draws itself: what a snapshot is shown with where there is no camera.
#pragma once

#include "../config/config.h"

#include "dicot/base/image.h"
#include "dicot/base/status.h"

#include <string>

namespace dicot::app {

/// Five leaves before a wall, 400 to 1000 mm from a rectified rig of 60 mm and 400 px. Integers only.
struct DrawnPair
{
    static constexpr int kWidth = 320; ///< px
    static constexpr int kHeight = 240;

    static void draw(ImageView<Rgb8> left, ImageView<Rgb8> right) noexcept;
};

/// The drawn pair and its rig file in a folder of its own, gone with the object.
class DrawnRig
{
public:
    DrawnRig() = default;
    DrawnRig(const DrawnRig&) = delete;
    DrawnRig& operator=(const DrawnRig&) = delete;
    ~DrawnRig();

    /// Makes `config` use them. Fault::kCannotCreate, kIoError.
    Status open(Config& config);

private:
    std::string folder_;
};

/// Whether this system has no camera at all, not even one that may not be opened.
bool no_camera_is_there();

} // namespace dicot::app
