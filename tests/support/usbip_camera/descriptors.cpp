#include "descriptors.h"

#include "controls.h"

#include <linux/usb/ch9.h>
#include <linux/usb/video.h>

#include <algorithm>
#include <initializer_list>

namespace dicot::usbip {

namespace {

constexpr int kMakerString = 1;
constexpr int kProductString = 2;
constexpr int kSerialString = 3;
constexpr std::size_t kMaxStringUnits = 126;

// Guid of YUY2, UVC payload specification "Uncompressed" 1.1, table 2-1.
constexpr std::uint8_t kYuy2[16] = {'Y', 'U', 'Y', '2', 0, 0, 0x10, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71};

/// One descriptor: its length stands in front when it is done.
class Descriptor
{
public:
    explicit Descriptor(int type) : bytes_{0, static_cast<std::uint8_t>(type)} {}

    Descriptor& u8(std::initializer_list<int> values)
    {
        for (const int value : values)
            bytes_.push_back(static_cast<std::uint8_t>(value));
        return *this;
    }
    Descriptor& u16(int value) { return u8({value & 255, value >> 8 & 255}); }
    Descriptor& u32(std::uint32_t value)
    {
        return u16(static_cast<int>(value & 0xFFFF)).u16(static_cast<int>(value >> 16));
    }
    Descriptor& raw(std::span<const std::uint8_t> bytes)
    {
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        return *this;
    }
    Bytes done() const
    {
        Bytes bytes = bytes_;
        bytes[0] = static_cast<std::uint8_t>(bytes.size());
        return bytes;
    }

private:
    Bytes bytes_;
};

void add(Bytes& all, const Bytes& more)
{
    all.insert(all.end(), more.begin(), more.end());
}

void put_u16(Bytes& bytes, std::size_t at, std::size_t value)
{
    bytes[at] = static_cast<std::uint8_t>(value & 255);
    bytes[at + 1] = static_cast<std::uint8_t>(value >> 8);
}

Bytes interface(int number, int alternate, int endpoints, int subclass)
{
    return Descriptor(USB_DT_INTERFACE)
        .u8({number, alternate, endpoints, USB_CLASS_VIDEO, subclass, UVC_PC_PROTOCOL_UNDEFINED, 0})
        .done();
}

Bytes control_interface_class()
{
    const std::array<std::uint8_t, 3> unit_bits = control_bits(kProcessingUnit);
    Bytes parts;
    add(parts, Descriptor(USB_DT_CS_INTERFACE)
                   .u8({UVC_VC_INPUT_TERMINAL, kCameraTerminal})
                   .u16(UVC_ITT_CAMERA)
                   .u8({0, 0})
                   .u16(0)
                   .u16(0)
                   .u16(0) // no optical zoom
                   .u8({3})
                   .raw(control_bits(kCameraTerminal))
                   .done());
    add(parts, Descriptor(USB_DT_CS_INTERFACE)
                   .u8({UVC_VC_PROCESSING_UNIT, kProcessingUnit, kCameraTerminal})
                   .u16(0)
                   .u8({2})
                   .raw(std::span(unit_bits).first(2))
                   .u8({0, 0})
                   .done());
    add(parts, Descriptor(USB_DT_CS_INTERFACE)
                   .u8({UVC_VC_OUTPUT_TERMINAL, kOutputTerminal})
                   .u16(UVC_TT_STREAMING)
                   .u8({0, kProcessingUnit, 0})
                   .done());

    constexpr std::size_t kHeadBytes = 13;
    Bytes all = Descriptor(USB_DT_CS_INTERFACE)
                    .u8({UVC_VC_HEADER})
                    .u16(0x0110)
                    .u16(static_cast<int>(kHeadBytes + parts.size()))
                    .u32(kClockHz)
                    .u8({1, kStreamInterface})
                    .done();
    add(all, parts);
    return all;
}

Bytes frame_descriptor(const CameraModel& camera, const Format& format, std::size_t at)
{
    const Mode& mode = format.modes[at];
    const int subtype = format.pixels == Pixels::kYuyv ? UVC_VS_FRAME_UNCOMPRESSED : UVC_VS_FRAME_MJPEG;
    const auto [slowest, fastest] = std::minmax_element(camera.rates_fps.begin(), camera.rates_fps.end());
    const std::uint32_t bits = mode.largest_frame_bytes * 8;
    Descriptor descriptor(USB_DT_CS_INTERFACE);
    descriptor.u8({subtype, static_cast<int>(at) + 1, 0})
        .u16(mode.width)
        .u16(mode.height)
        .u32(bits * static_cast<std::uint32_t>(*slowest))
        .u32(bits * static_cast<std::uint32_t>(*fastest))
        .u32(mode.largest_frame_bytes)
        .u32(interval_of(camera.rates_fps.front()))
        .u8({static_cast<int>(camera.rates_fps.size())});
    for (const int rate_fps : camera.rates_fps)
        descriptor.u32(interval_of(rate_fps));
    return descriptor.done();
}

Bytes format_descriptors(const CameraModel& camera, std::size_t at)
{
    const Format& format = camera.formats[at];
    Bytes all;
    Descriptor head(USB_DT_CS_INTERFACE);
    const int index = static_cast<int>(at) + 1;
    const int modes = static_cast<int>(format.modes.size());
    if (format.pixels == Pixels::kYuyv)
        head.u8({UVC_VS_FORMAT_UNCOMPRESSED, index, modes}).raw(kYuy2).u8({16, 1, 0, 0, 0, 0});
    else
        head.u8({UVC_VS_FORMAT_MJPEG, index, modes, 0, 1, 0, 0, 0, 0});
    add(all, head.done());
    for (std::size_t i = 0; i < format.modes.size(); ++i)
        add(all, frame_descriptor(camera, format, i));
    // BT.709 primaries and transfer, BT.601 matrix: what most webcams say.
    add(all, Descriptor(USB_DT_CS_INTERFACE).u8({UVC_VS_COLORFORMAT, 1, 1, 4}).done());
    return all;
}

Bytes stream_interface_class(const CameraModel& camera)
{
    Bytes parts;
    for (std::size_t i = 0; i < camera.formats.size(); ++i)
        add(parts, format_descriptors(camera, i));
    const std::size_t head_bytes = 13 + camera.formats.size();
    Descriptor head(USB_DT_CS_INTERFACE);
    head.u8({UVC_VS_INPUT_HEADER, static_cast<int>(camera.formats.size())})
        .u16(static_cast<int>(head_bytes + parts.size()))
        .u8({USB_DIR_IN | static_cast<int>(kVideoEndpoint), 0, kOutputTerminal, 0, 0, 0, 1});
    for (std::size_t i = 0; i < camera.formats.size(); ++i)
        head.u8({0});
    Bytes all = head.done();
    add(all, parts);
    return all;
}

Bytes video_endpoint(int transfer, int packet_word)
{
    return Descriptor(USB_DT_ENDPOINT)
        .u8({USB_DIR_IN | static_cast<int>(kVideoEndpoint), transfer})
        .u16(packet_word)
        .u8({transfer == USB_ENDPOINT_XFER_BULK ? 0 : 1})
        .done();
}

// UTF-8 into UTF-16 units; a byte that begins no sequence of up to three bytes stands for itself.
std::vector<int> units_of(std::string_view text)
{
    std::vector<int> units;
    for (std::size_t i = 0; i < text.size() && units.size() < kMaxStringUnits;) {
        const auto byte = [&](std::size_t at) {
            return at < text.size() ? static_cast<int>(static_cast<unsigned char>(text[at])) : 0;
        };
        const int first = byte(i);
        if ((first & 0xE0) == 0xC0 && (byte(i + 1) & 0xC0) == 0x80) {
            units.push_back((first & 0x1F) << 6 | (byte(i + 1) & 0x3F));
            i += 2;
        } else if ((first & 0xF0) == 0xE0 && (byte(i + 1) & 0xC0) == 0x80 && (byte(i + 2) & 0xC0) == 0x80) {
            units.push_back((first & 0x0F) << 12 | (byte(i + 1) & 0x3F) << 6 | (byte(i + 2) & 0x3F));
            i += 3;
        } else {
            units.push_back(first);
            i += 1;
        }
    }
    return units;
}

} // namespace

Bytes device_descriptor(const CameraModel& camera)
{
    return Descriptor(USB_DT_DEVICE)
        .u16(0x0200)
        .u8({USB_CLASS_MISC, 2, 1, 64}) // an interface association follows
        .u16(camera.vendor_id)
        .u16(camera.product_id)
        .u16(0x0100)
        .u8({kMakerString, kProductString, kSerialString, 1})
        .done();
}

Bytes configuration_descriptor(const CameraModel& camera)
{
    Bytes all = Descriptor(USB_DT_CONFIG).u16(0).u8({2, 1, 0, USB_CONFIG_ATT_ONE, 250}).done();
    add(all, Descriptor(USB_DT_INTERFACE_ASSOCIATION)
                 .u8({kControlInterface, 2, USB_CLASS_VIDEO, UVC_SC_VIDEO_INTERFACE_COLLECTION, 0, kProductString})
                 .done());
    add(all, interface(kControlInterface, 0, 1, UVC_SC_VIDEOCONTROL));
    add(all, control_interface_class());
    add(all, Descriptor(USB_DT_ENDPOINT)
                 .u8({USB_DIR_IN | static_cast<int>(kStatusEndpoint), USB_ENDPOINT_XFER_INT})
                 .u16(16)
                 .u8({8})
                 .done());
    add(all, Descriptor(USB_DT_CS_ENDPOINT).u8({UVC_EP_INTERRUPT}).u16(16).done());

    add(all, interface(kStreamInterface, 0, camera.bulk ? 1 : 0, UVC_SC_VIDEOSTREAMING));
    add(all, stream_interface_class(camera));
    if (camera.bulk) {
        add(all, video_endpoint(USB_ENDPOINT_XFER_BULK, 512));
    } else {
        constexpr int kAsynchronous = 4;
        for (std::size_t i = 0; i < camera.alternates.size(); ++i) {
            const Alternate& alternate = camera.alternates[i];
            add(all, interface(kStreamInterface, static_cast<int>(i) + 1, 1, UVC_SC_VIDEOSTREAMING));
            add(all, video_endpoint(USB_ENDPOINT_XFER_ISOC | kAsynchronous,
                                    (alternate.packets_a_microframe - 1) << 11 | alternate.packet_bytes));
        }
    }
    put_u16(all, 2, all.size());
    return all;
}

Bytes string_descriptor(const CameraModel& camera, int index)
{
    Descriptor descriptor(USB_DT_STRING);
    switch (index) {
    case 0:
        return descriptor.u16(0x0409).done();
    case kMakerString:
        for (const int unit : units_of("dicot"))
            descriptor.u16(unit);
        return descriptor.done();
    case kProductString:
        for (const int unit : units_of(camera.product))
            descriptor.u16(unit);
        return descriptor.done();
    case kSerialString:
        for (const int unit : units_of(camera.serial))
            descriptor.u16(unit);
        return descriptor.done();
    default:
        return {};
    }
}

} // namespace dicot::usbip
