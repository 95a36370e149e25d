#include "functions.h"

#include "chain.h"

#include <algorithm>

namespace dicot {
namespace {

// bDescriptorSubtype (UVC, table A-5) and wTerminalType (table B-2).
constexpr std::uint8_t kHeader = 1;
constexpr std::uint8_t kInputTerminal = 2;
constexpr std::uint8_t kProcessingUnit = 5;
constexpr std::uint16_t kCameraTerminal = 0x0201;

/// bControlSize at `at`, and behind it as many bytes of bmControls (UVC, tables 3-6 and 3-8).
std::uint32_t controls_at(Bytes descriptor, std::size_t at) noexcept
{
    const std::size_t told = u8_at(descriptor, at);
    const std::size_t held = std::min({told, descriptor.size() - at - 1, std::size_t{4}});
    std::uint32_t controls = 0;
    for (std::size_t i = 0; i < held; ++i)
        controls |= std::uint32_t{u8_at(descriptor, at + 1 + i)} << (8 * i);
    return controls;
}

void read_header(Bytes descriptor, UvcDevice& device, Collection& collection) noexcept
{
    device.version = u16_at(descriptor, 3);
    device.clock_hz = u32_at(descriptor, 7);
    const std::size_t told = u8_at(descriptor, 11);
    const std::size_t held = std::min({told, descriptor.size() - 12, std::size_t{Collection::kMost}});
    for (std::size_t i = 0; i < held; ++i)
        collection.interfaces[i] = u8_at(descriptor, 12 + i);
    collection.count = static_cast<std::uint8_t>(held);
}

} // namespace

Result<Collection> read_video_control(Bytes chain, std::uint8_t number, UvcDevice& device) noexcept
{
    Collection collection;
    bool here = false;
    bool told = false;
    ChainWalk walk(chain);
    for (Bytes one = walk.next(); !one.empty(); one = walk.next()) {
        if (is_interface(one)) {
            const InterfaceHead head = interface_of(one);
            here = head.number == number && head.subclass == kVideoControl;
        }
        if (!here || type_of(one) != kClassInterface || one.size() < 3)
            continue;
        const std::uint8_t subtype = u8_at(one, 2);
        if (subtype == kHeader && one.size() >= 12 && !told) {
            read_header(one, device, collection);
            told = true;
        } else if (subtype == kInputTerminal && one.size() >= 15 && u16_at(one, 4) == kCameraTerminal &&
                   device.camera.id == 0) {
            device.camera = {u8_at(one, 3), controls_at(one, 14)};
        } else if (subtype == kProcessingUnit && one.size() >= 8 && device.processing.id == 0) {
            device.processing = {u8_at(one, 3), controls_at(one, 7)};
        }
    }
    if (!told)
        return failure(Fault::kBadData, "its video control interface %u has no header (UVC 3.7.2)", unsigned{number});
    if (device.version < 0x0100 || device.version >= 0x0200)
        return failure(Fault::kUnavailable, "it speaks version %x.%02x of the USB Video Class, dicot 1.0 to 1.5",
                       unsigned{device.version} >> 8, unsigned{device.version} & 0xFF);
    if (collection.count == 0)
        return failure(Fault::kBadData, "its video control interface %u names no streaming interface (UVC 3.7.2)",
                       unsigned{number});
    return collection;
}

} // namespace dicot
