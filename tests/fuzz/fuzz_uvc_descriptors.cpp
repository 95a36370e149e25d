// Any bytes at all as the descriptors of a camera.
#include "dicot/uvc_parse/descriptors.h"

#include <array>
#include <cstdlib>

namespace {

void require(bool promise)
{
    if (!promise)
        std::abort();
}

void require_sound(const dicot::UvcDevice& device)
{
    using namespace dicot;
    require(device.format_count <= UvcDevice::kMostFormats && device.frame_count <= UvcDevice::kMostFrames);
    require(device.alternate_count <= UvcDevice::kMostAlternates && device.alternate_count > 0 &&
            device.frame_count > 0);
    require(device.version >= 0x0100 && device.version < 0x0200);
    int next_frame = 0;
    for (const UvcFormat& format : device.usable_formats()) {
        require(format.first_frame == next_frame);
        next_frame += format.frame_count;
        for (const UvcFrame& frame : device.frames_of(format)) {
            require(frame.width > 0 && frame.width <= kMostUvcSide && frame.height > 0 && frame.height <= kMostUvcSide);
            require(frame.interval_count > 0 && frame.interval_count <= UvcFrame::kMostIntervals);
            require(frame.intervals_100ns[0] > 0);
        }
    }
    require(next_frame == device.frame_count);
    for (const UvcAlternate& one : device.settings()) {
        require(one.setting.bytes_per_interval > 0 && one.setting.intervals_apart > 0 && (one.endpoint & 0x80) != 0);
        require(one.bulk == device.bulk());
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot;
    // The first byte is the configuration that counts.
    const std::uint8_t configuration = size > 0 ? data[0] : 0;
    const auto bytes = std::as_bytes(std::span{data, size}).subspan(size > 0 ? 1 : 0);
    const Result<UvcDevice> read = parse_uvc_device(bytes, configuration);
    if (!read.ok()) {
        require(read.status().message()[0] != '\0');
        require(read.status().fault() == Fault::kBadData || read.status().fault() == Fault::kUnavailable);
        return 0;
    }
    const UvcDevice& device = read.value();
    require_sound(device);
    require(configuration == 0 || device.configuration == configuration);
    static std::array<CameraMode, 2048> modes;
    const std::size_t count = modes_of(device, modes);
    require(count > 0);
    std::size_t largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto place = place_of(device, modes[i]);
        require(place.has_value());
        largest = std::max(largest, place->room_bytes);
    }
    require(largest <= largest_frame_bytes(device));
    require(largest_frame_bytes(device) <= std::size_t{kMostUvcSide} * kMostUvcSide * 2 + 65536);
    return 0;
}
