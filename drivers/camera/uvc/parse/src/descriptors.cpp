#include "dicot/uvc_parse/descriptors.h"

#include "chain.h"
#include "functions.h"

#include <algorithm>

namespace dicot {
namespace {

constexpr std::size_t kDeviceBytes = 18;
constexpr std::size_t kConfigurationBytes = 9;
constexpr int kMostFunctions = 8; ///< video functions that are tried before the device is given up

struct Configuration
{
    std::uint8_t value = 0;
    Bytes chain; ///< behind its own descriptor
};

Result<Configuration> find_configuration(Bytes descriptors, std::uint8_t wanted) noexcept
{
    std::size_t at = kDeviceBytes;
    while (at < descriptors.size()) {
        const Bytes rest = descriptors.subspan(at);
        if (rest.size() < kConfigurationBytes || u8_at(rest, 0) < kConfigurationBytes || u8_at(rest, 0) > rest.size() ||
            type_of(rest) != kConfigurationDescriptor)
            return failure(Fault::kBadData, "at byte %zu of its descriptors no configuration begins (USB 2.0, 9.6.3)",
                           at);
        const std::size_t total = u16_at(rest, 2);
        if (total < u8_at(rest, 0))
            return failure(Fault::kBadData, "its configuration at byte %zu says that it has %zu bytes (USB 2.0, 9.6.3)",
                           at, total);
        if (total > rest.size())
            return failure(Fault::kBadData, "its configuration is cut short: %zu of %zu bytes", rest.size(), total);
        if (wanted == 0 || u8_at(rest, 5) == wanted) {
            const std::size_t head = u8_at(rest, 0);
            const Bytes chain = rest.subspan(head, total - head);
            TRY(check_chain(chain, at + head));
            return Configuration{u8_at(rest, 5), chain};
        }
        at += total;
    }
    return failure(Fault::kBadData, "its descriptors hold no configuration %u", unsigned{wanted});
}

/// One video function: its control interface and the first of its streaming interfaces that can be used.
Result<UvcDevice> read_function(Bytes chain, std::uint8_t control_interface, const UvcDevice& blank) noexcept
{
    UvcDevice controlled = blank;
    controlled.control_interface = control_interface;
    const Collection collection = TRY(read_video_control(chain, control_interface, controlled));
    Status why;
    for (std::uint8_t i = 0; i < collection.count; ++i) {
        UvcDevice device = controlled;
        device.streaming_interface = collection.interfaces[i];
        const Status read = read_video_streaming(chain, device.streaming_interface, device);
        if (read.ok())
            return device;
        if (why.ok())
            why = read;
    }
    return why;
}

} // namespace

Status check_chain(Bytes chain, std::size_t offset) noexcept
{
    std::size_t at = 0;
    while (at < chain.size()) {
        const std::size_t length = u8_at(chain, at);
        if (length < 2 || length > chain.size() - at)
            return failure(Fault::kBadData, "its descriptor at byte %zu says that it has %zu bytes of the %zu left",
                           offset + at, length, chain.size() - at);
        at += length;
    }
    return {};
}

Result<UvcDevice> parse_uvc_device(Bytes descriptors, std::uint8_t configuration) noexcept
{
    if (descriptors.size() < kDeviceBytes || u8_at(descriptors, 0) != kDeviceBytes ||
        type_of(descriptors) != kDeviceDescriptor)
        return failure(Fault::kBadData, "its device descriptor is damaged or cut short (USB 2.0, 9.6.1)");
    const Configuration chosen = TRY(find_configuration(descriptors, configuration));
    UvcDevice blank;
    blank.vendor = u16_at(descriptors, 8);
    blank.product = u16_at(descriptors, 10);
    blank.configuration = chosen.value;

    UvcDevice found;
    Status why = failure(Fault::kUnavailable, "it has no video interface");
    bool usable = false;
    int functions = 0;
    ChainWalk walk(chosen.chain);
    for (Bytes one = walk.next(); !one.empty(); one = walk.next()) {
        if (!is_interface(one))
            continue;
        const InterfaceHead head = interface_of(one);
        if (head.subclass != kVideoControl || head.alternate != 0)
            continue;
        ++functions;
        if (usable || functions > kMostFunctions)
            continue;
        const Result<UvcDevice> read = read_function(chosen.chain, head.number, blank);
        usable = read.ok();
        if (usable)
            found = read.value();
        else if (functions == 1)
            why = read.status();
    }
    if (!usable)
        return why;
    found.other_cameras = static_cast<std::uint16_t>(functions - 1);
    return found;
}

} // namespace dicot
