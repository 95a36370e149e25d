#include "dicot/camera/mode.h"
#include "dicot/camera/frame.h"

namespace dicot {

const char* name_of(PixelFormat format) noexcept
{
    switch (format) {
    case PixelFormat::kYuyv:
        return "YUYV";
    case PixelFormat::kMjpeg:
        return "MJPEG";
    case PixelFormat::kNv12:
        return "NV12";
    case PixelFormat::kGrey:
        return "GREY";
    case PixelFormat::kRgb24:
        return "RGB24";
    }
    return "?";
}

const char* name_of(FrameVerdict verdict) noexcept
{
    switch (verdict) {
    case FrameVerdict::kWhole:
        return "whole";
    case FrameVerdict::kTorn:
        return "torn";
    case FrameVerdict::kCancelled:
        return "cancelled";
    case FrameVerdict::kWarmingUp:
        return "warming up";
    }
    return "?";
}

std::size_t frame_bytes(const CameraMode& mode) noexcept
{
    const std::size_t pixels = static_cast<std::size_t>(mode.width) * static_cast<std::size_t>(mode.height);
    switch (mode.format) {
    case PixelFormat::kYuyv:
        return 2 * pixels;
    case PixelFormat::kNv12:
        return pixels * 3 / 2;
    case PixelFormat::kGrey:
        return pixels;
    case PixelFormat::kRgb24:
        return 3 * pixels;
    case PixelFormat::kMjpeg:
        return 0;
    }
    return 0;
}

} // namespace dicot
