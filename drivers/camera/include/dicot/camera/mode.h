// What a camera can be asked to deliver.
#pragma once

#include <cstddef>
#include <cstdint>

namespace dicot {

/// How the bytes of a frame mean pixels.
enum class PixelFormat : std::uint8_t
{
    kYuyv, ///< Y0 U Y1 V, 16 bits a pixel (USB Video Payload Uncompressed, GUID YUY2)
    kMjpeg,
    kNv12,  ///< a plane of Y, then a plane of U V pairs at half the size each way
    kGrey,  ///< 8 bits (V4L2's GREY, UVC's Y800)
    kRgb24, ///< R G B, 8 bits each: recorded pictures, which are to arrive as they are
};
const char* name_of(PixelFormat format) noexcept;

struct CameraMode
{
    PixelFormat format = PixelFormat::kYuyv;
    int width = 0; ///< px
    int height = 0;
    std::uint32_t interval_100ns = 0; ///< between two frames, in UVC's unit

    friend bool operator==(const CameraMode&, const CameraMode&) = default;
};

/// Bytes of one frame; 0 of compressed formats, whose frames have no fixed size.
std::size_t frame_bytes(const CameraMode& mode) noexcept;

} // namespace dicot
