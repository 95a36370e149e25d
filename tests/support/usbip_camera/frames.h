// The pictures that a camera shows: files of a folder, mapped, unchanged.
#pragma once

#include "dicot/base/status.h"

#include "model.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dicot::usbip {

/// Files named <width>x<height>_<anything>.yuyv or .jpg; in the order of their names they are the frames of that size
/// and format. What else lies in the folder is not looked at.
class FrameFolder
{
public:
    FrameFolder() = default;
    FrameFolder(const FrameFolder&) = delete;
    FrameFolder& operator=(const FrameFolder&) = delete;
    FrameFolder(FrameFolder&&) = default;
    FrameFolder& operator=(FrameFolder&&) = default;
    ~FrameFolder();

    /// Fault::kNoInput: no such folder, or no frame in it. Fault::kBadData: a .yuyv file that is not 2 bytes a pixel,
    /// an empty file.
    Status open(const std::string& path);

    /// YUYV before MJPEG, small sizes before large ones.
    std::vector<Format> formats() const;
    /// Frame `number` modulo the count of files of this format and mode, as formats() numbers them.
    std::span<const std::uint8_t> frame(std::size_t format, std::size_t mode, std::uint64_t number) const;

private:
    struct Series
    {
        Pixels pixels = Pixels::kYuyv;
        int width = 0;
        int height = 0;
        std::vector<std::span<const std::uint8_t>> frames;
    };
    Status add(const std::string& path, const std::string& name);
    const Series* series(std::size_t format, std::size_t mode) const;

    std::vector<Series> series_; ///< sorted as formats() tells
};

} // namespace dicot::usbip
