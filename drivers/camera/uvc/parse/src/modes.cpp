#include "dicot/uvc_parse/descriptors.h"

#include <algorithm>

namespace dicot {
namespace {

// 60, 30, 25, 20, 15, 10, 5 and 1 frames a second.
constexpr std::array<std::uint32_t, 8> kUsualIntervals{166'666, 333'333,   400'000,   500'000,
                                                       666'666, 1'000'000, 2'000'000, 10'000'000};

bool offers(const UvcFrame& frame, std::uint32_t interval) noexcept
{
    const auto told = std::span{frame.intervals_100ns}.first(frame.interval_count);
    if (!frame.continuous)
        return std::ranges::find(told, interval) != told.end();
    return interval >= told[0] && interval <= told[1];
}

/// Compressed frames: what the device says, but never more than 2 bytes a pixel and a thumbnail's worth of headers.
std::size_t room_of(PixelFormat format, const UvcFrame& frame) noexcept
{
    const CameraMode mode{format, frame.width, frame.height, 0};
    if (const std::size_t exact = frame_bytes(mode); exact != 0)
        return exact;
    const std::size_t most = std::size_t{2} * frame.width * frame.height + std::size_t{64} * 1024;
    return frame.most_bytes == 0 ? most : std::min<std::size_t>(most, frame.most_bytes);
}

} // namespace

std::size_t modes_of(const UvcDevice& device, std::span<CameraMode> modes) noexcept
{
    std::size_t count = 0;
    for (const UvcFormat& format : device.usable_formats()) {
        for (const UvcFrame& frame : device.frames_of(format)) {
            const auto add = [&](std::uint32_t interval) {
                if (count < modes.size())
                    modes[count++] = {format.format, frame.width, frame.height, interval};
            };
            if (!frame.continuous) {
                for (std::uint8_t i = 0; i < frame.interval_count; ++i)
                    add(frame.intervals_100ns[i]);
                continue;
            }
            const std::uint32_t least = frame.intervals_100ns[0];
            const std::uint32_t most = frame.intervals_100ns[1];
            add(least);
            for (const std::uint32_t usual : kUsualIntervals)
                if (usual > least && usual < most)
                    add(usual);
            if (most > least)
                add(most);
        }
    }
    return count;
}

std::optional<UvcModePlace> place_of(const UvcDevice& device, const CameraMode& mode) noexcept
{
    for (const UvcFormat& format : device.usable_formats()) {
        if (format.format != mode.format)
            continue;
        for (const UvcFrame& frame : device.frames_of(format))
            if (frame.width == mode.width && frame.height == mode.height && offers(frame, mode.interval_100ns))
                return UvcModePlace{format.index, frame.index, room_of(format.format, frame)};
    }
    return std::nullopt;
}

std::size_t settings_of(const UvcDevice& device, std::span<AlternateSetting> settings) noexcept
{
    const auto told = device.settings().first(std::min<std::size_t>(settings.size(), device.alternate_count));
    std::ranges::transform(told, settings.begin(), &UvcAlternate::setting);
    return told.size();
}

std::size_t largest_frame_bytes(const UvcDevice& device) noexcept
{
    std::size_t largest = 0;
    for (const UvcFormat& format : device.usable_formats())
        for (const UvcFrame& frame : device.frames_of(format))
            largest = std::max(largest, room_of(format.format, frame));
    return largest;
}

} // namespace dicot
