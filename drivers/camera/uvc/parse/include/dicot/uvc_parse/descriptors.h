// What a camera of the USB Video Class says of itself, read out of its descriptors as hostile input.
//
// "UVC" is the USB Device Class Definition for Video Devices 1.5, "USB 2.0" and "USB 3.2" the specifications of the
// bus.
#pragma once

#include "dicot/base/status.h"
#include "dicot/camera/bandwidth.h"
#include "dicot/camera/mode.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace dicot {

/// A frame descriptor (UVC Payload Uncompressed 3.1.2, UVC Payload MJPEG 3.1.2): one picture size of a format.
struct UvcFrame
{
    static constexpr int kMostIntervals = 16;

    std::uint8_t index = 0;       ///< bFrameIndex, the word of the negotiation
    std::uint16_t width = 0;      ///< px
    std::uint16_t height = 0;     ///< px
    std::uint32_t most_bytes = 0; ///< dwMaxVideoFrameBufferSize: what the device says, trusted by nobody
    bool continuous = false;      ///< the intervals are least, most and step
    std::uint8_t interval_count = 0;
    std::array<std::uint32_t, kMostIntervals> intervals_100ns{};
};

/// A format descriptor whose pixels dicot can read.
struct UvcFormat
{
    std::uint8_t index = 0; ///< bFormatIndex
    PixelFormat format{};
    std::uint8_t first_frame = 0; ///< its frames lie at UvcDevice::frames[first_frame] and on
    std::uint8_t frame_count = 0;
};

/// An alternate setting of the streaming interface with the endpoint that the video comes through.
struct UvcAlternate
{
    AlternateSetting setting;
    std::uint8_t endpoint = 0; ///< address, bit 7 set
    bool bulk = false;
};

/// A terminal or a unit with controls (UVC 3.7.2).
struct UvcEntity
{
    std::uint8_t id = 0;        ///< 0: the device has none
    std::uint32_t controls = 0; ///< bmControls, its first 32 bits
};

/// The first usable camera of a device. What is more than there is room for is left out and counted.
struct UvcDevice
{
    static constexpr int kMostFormats = 8;
    static constexpr int kMostFrames = 96;
    static constexpr int kMostAlternates = 32;

    std::uint16_t vendor = 0;
    std::uint16_t product = 0;
    std::uint8_t configuration = 0; ///< bConfigurationValue
    std::uint16_t version = 0;      ///< bcdUVC: 0x0100, 0x0110, 0x0150
    std::uint32_t clock_hz = 0;     ///< dwClockFrequency, the unit of PTS and SCR
    std::uint8_t control_interface = 0;
    std::uint8_t streaming_interface = 0;
    UvcEntity camera;     ///< camera terminal
    UvcEntity processing; ///< processing unit

    std::uint8_t format_count = 0;
    std::uint8_t frame_count = 0;
    std::uint8_t alternate_count = 0;
    std::array<UvcFormat, kMostFormats> formats{};
    std::array<UvcFrame, kMostFrames> frames{};
    std::array<UvcAlternate, kMostAlternates> alternates{};

    std::uint16_t other_cameras = 0; ///< further video functions of the same device
    std::uint16_t left_out = 0;      ///< formats, frames, intervals and settings that are unusable or too many

    std::span<const UvcFrame> frames_of(const UvcFormat& format) const noexcept
    {
        return std::span{frames}.subspan(format.first_frame, format.frame_count);
    }
    std::span<const UvcFormat> usable_formats() const noexcept { return std::span{formats}.first(format_count); }
    std::span<const UvcAlternate> settings() const noexcept { return std::span{alternates}.first(alternate_count); }
    bool bulk() const noexcept { return alternate_count > 0 && alternates[0].bulk; }
};

/// Longest side of a picture that is believed, in pixels.
constexpr int kMostUvcSide = 8192;

/// Reads `descriptors`: a device descriptor and its configurations, as Linux keeps them in sysfs. `configuration` is
/// the bConfigurationValue that counts; 0 takes the first. Fault::kBadData: damaged, with the byte where;
/// Fault::kUnavailable: there is no camera in it, or none that can be used.
Result<UvcDevice> parse_uvc_device(std::span<const std::byte> descriptors, std::uint8_t configuration) noexcept;

/// Where in the device's own numbers a mode lies.
struct UvcModePlace
{
    std::uint8_t format_index = 0;
    std::uint8_t frame_index = 0;
    std::size_t room_bytes = 0; ///< a frame never needs more
};

/// Every mode of the device, in its own order, as far as `modes` has room; a continuous range of intervals stands for
/// its ends and the usual rates between them. Returns how many.
std::size_t modes_of(const UvcDevice& device, std::span<CameraMode> modes) noexcept;
std::optional<UvcModePlace> place_of(const UvcDevice& device, const CameraMode& mode) noexcept;

/// The alternate settings in the planner's words, as far as `settings` has room. Returns how many.
std::size_t settings_of(const UvcDevice& device, std::span<AlternateSetting> settings) noexcept;

/// Bytes of the largest frame of all modes: 0 of a device without modes.
std::size_t largest_frame_bytes(const UvcDevice& device) noexcept;

} // namespace dicot
