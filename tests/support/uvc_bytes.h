// Descriptors of cameras, put together by hand.
//
// The C270's fields are those of public `lsusb -v` listings of 046d:0825 (its nineteen picture sizes cut down to
// three); the C920's, of 046d:082d, as far as they differ in kind: an H.264 format between the others, a focus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace dicot::test {

class DescriptorBytes
{
public:
    DescriptorBytes& add(std::initializer_list<int> bytes)
    {
        for (const int one : bytes)
            bytes_.push_back(static_cast<std::byte>(one));
        return *this;
    }
    /// A descriptor whose length is counted.
    DescriptorBytes& part(std::initializer_list<int> bytes)
    {
        add({static_cast<int>(bytes.size() + 1)});
        return add(bytes);
    }
    DescriptorBytes& device(int vendor, int product)
    {
        return add(
            {18, 1, 0, 2, 0xEF, 2, 1, 64, low(vendor), high(vendor), low(product), high(product), 0x10, 0, 0, 0, 2, 1});
    }
    DescriptorBytes& configuration(int value, int interfaces)
    {
        start_ = bytes_.size();
        return add({9, 2, 0, 0, interfaces, value, 0, 0x80, 250});
    }
    /// wTotalLength of the configuration that was begun last.
    DescriptorBytes& end_configuration()
    {
        const auto total = static_cast<int>(bytes_.size() - start_);
        bytes_[start_ + 2] = static_cast<std::byte>(low(total));
        bytes_[start_ + 3] = static_cast<std::byte>(high(total));
        return *this;
    }
    DescriptorBytes& interface(int number, int alternate, int endpoints, int video_class, int subclass)
    {
        return part({4, number, alternate, endpoints, video_class, subclass, 0, 0});
    }
    DescriptorBytes& endpoint(int address, int attributes, int packet, int interval)
    {
        return part({5, address, attributes, low(packet), high(packet), interval});
    }
    DescriptorBytes& companion(int bytes_per_interval)
    {
        return part({0x30, 0, 0, low(bytes_per_interval), high(bytes_per_interval)});
    }
    DescriptorBytes& control_header(int version, std::uint32_t clock_hz, std::initializer_list<int> interfaces)
    {
        add({12 + static_cast<int>(interfaces.size()), 0x24, 1, low(version), high(version), 0, 0});
        number(clock_hz);
        add({static_cast<int>(interfaces.size())});
        return add(interfaces);
    }
    DescriptorBytes& camera_terminal(int id, std::uint32_t controls)
    {
        return part({0x24, 2, id, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0, 3, at(controls, 0), at(controls, 1), at(controls, 2)});
    }
    DescriptorBytes& processing_unit(int id, int source, std::uint32_t controls)
    {
        return part({0x24, 5, id, source, 0, 0x40, 2, at(controls, 0), at(controls, 1), 0, 0x1B});
    }
    DescriptorBytes& extension_unit(int id)
    {
        return part({0x24, 6,    id,   0x82, 6,    0x61, 0x63, 0x70, 0x50, 0x49, 0xB8, 0xCC, 0xB3,
                     0x85, 0x5E, 0x8D, 0x1D, 0xA6, 4,    1,    1,    1,    3,    0,    0});
    }
    DescriptorBytes& input_header(int formats, int endpoint_address)
    {
        add({13 + formats, 0x24, 1, formats, 0, 0, endpoint_address, 0, 4, 0, 0, 0, 1});
        for (int i = 0; i < formats; ++i)
            add({0});
        return *this;
    }
    /// `fourcc` and the tail of all such GUIDs.
    DescriptorBytes& uncompressed(int index, std::string_view fourcc, int frames, int interlace = 0)
    {
        add({27, 0x24, 4, index, frames});
        for (const char c : fourcc)
            add({c});
        return add({0, 0, 0x10, 0, 0x80, 0, 0, 0xAA, 0, 0x38, 0x9B, 0x71, 16, 1, 0, 0, interlace, 0});
    }
    DescriptorBytes& mjpeg(int index, int frames) { return part({0x24, 6, index, frames, 1, 1, 0, 0, 0, 0}); }
    DescriptorBytes& h264_by_frames(int index, int frames)
    {
        add({28, 0x24, 0x10, index, frames, 'H', '2', '6', '4'});
        return add({0, 0, 0x10, 0, 0x80, 0, 0, 0xAA, 0, 0x38, 0x9B, 0x71, 0, 1, 0, 0, 0, 0, 1});
    }
    /// `subtype` 5 uncompressed, 7 MJPEG, 0x11 frame based.
    DescriptorBytes& frame(int subtype, int index, int width, int height,
                           std::initializer_list<std::uint32_t> intervals)
    {
        add({26 + 4 * static_cast<int>(intervals.size()), 0x24, subtype, index, 0, low(width), high(width), low(height),
             high(height)});
        const std::uint32_t pixels = static_cast<std::uint32_t>(width) * static_cast<std::uint32_t>(height);
        number(pixels * 16 * 5);
        number(pixels * 16 * 30);
        number(pixels * 2);
        number(intervals.size() == 0 ? 0 : *intervals.begin());
        add({static_cast<int>(intervals.size())});
        for (const std::uint32_t interval : intervals)
            number(interval);
        return *this;
    }
    DescriptorBytes& range_frame(int subtype, int index, int width, int height, std::uint32_t least, std::uint32_t most,
                                 std::uint32_t step)
    {
        frame(subtype, index, width, height, {least, most, step});
        bytes_[bytes_.size() - 13] = std::byte{0}; // bFrameIntervalType: a range
        return *this;
    }
    DescriptorBytes& number(std::uint32_t value)
    {
        return add({at(value, 0), at(value, 1), at(value, 2), at(value, 3)});
    }

    const std::vector<std::byte>& bytes() const { return bytes_; }

private:
    static int low(int value) { return value & 0xFF; }
    static int high(int value) { return value >> 8 & 0xFF; }
    static int at(std::uint32_t value, int byte) { return static_cast<int>(value >> (8 * byte) & 0xFF); }

    std::vector<std::byte> bytes_;
    std::size_t start_ = 0;
};

inline DescriptorBytes c270_bytes()
{
    DescriptorBytes c270;
    c270.device(0x046D, 0x0825).configuration(1, 4);
    c270.part({11, 0, 2, 14, 3, 0, 0});
    c270.interface(0, 0, 1, 14, 1).control_header(0x0100, 48'000'000, {1}).camera_terminal(1, 0x00000E);
    c270.processing_unit(2, 1, 0x175B).extension_unit(3).extension_unit(4);
    c270.part({0x24, 3, 5, 1, 1, 0, 4, 0}).endpoint(0x87, 3, 16, 8).part({0x25, 3, 16, 0});
    c270.interface(1, 0, 0, 14, 2).input_header(2, 0x81);
    const std::initializer_list<std::uint32_t> rates = {333'333, 400'000, 500'000, 666'666, 1'000'000, 2'000'000};
    c270.uncompressed(1, "YUY2", 3).frame(5, 1, 640, 480, rates).frame(5, 2, 160, 120, rates);
    c270.frame(5, 3, 1280, 960, {1'333'333, 2'000'000});
    c270.part({0x24, 3, 0, 1, 128, 2, 224, 1, 0}).part({0x24, 13, 1, 1, 4});
    c270.mjpeg(2, 2).frame(7, 1, 640, 480, rates).frame(7, 2, 1280, 960, rates).part({0x24, 13, 1, 1, 4});
    int alternate = 0;
    for (const int packet : {0x00C0, 0x0180, 0x0200, 0x0280, 0x0320, 0x03B0, 0x0A80, 0x0B20, 0x0BE0, 0x1380, 0x13FC})
        c270.interface(1, ++alternate, 1, 14, 2).endpoint(0x81, 5, packet, 1);
    c270.interface(2, 0, 0, 1, 1); // the microphone
    return c270.end_configuration();
}

inline DescriptorBytes c920_bytes()
{
    DescriptorBytes c920;
    c920.device(0x046D, 0x082D).configuration(1, 4);
    c920.part({11, 0, 2, 14, 3, 0, 0});
    c920.interface(0, 0, 1, 14, 1).control_header(0x0100, 30'000'000, {1}).camera_terminal(1, 0x020A2E);
    c920.processing_unit(3, 1, 0x175B).extension_unit(6).endpoint(0x83, 3, 64, 8);
    c920.interface(1, 0, 0, 14, 2).input_header(3, 0x81);
    c920.uncompressed(1, "YUY2", 1).frame(5, 1, 640, 480, {333'333, 2'000'000});
    c920.h264_by_frames(2, 1).frame(0x11, 1, 1920, 1080, {333'333});
    c920.mjpeg(3, 1).frame(7, 1, 1920, 1080, {333'333, 2'000'000});
    c920.interface(1, 1, 1, 14, 2).endpoint(0x81, 5, 0x00C0, 1);
    c920.interface(1, 2, 1, 14, 2).endpoint(0x81, 5, 0x1400, 1);
    return c920.end_configuration();
}

/// A camera as small as it can be; the frame and the endpoint are the caller's.
inline DescriptorBytes plain_camera_head(int version = 0x0110)
{
    DescriptorBytes camera;
    camera.device(0x1234, 0x5678).configuration(1, 2);
    camera.interface(0, 0, 0, 14, 1).control_header(version, 15'000'000, {1});
    camera.interface(1, 0, 0, 14, 2);
    return camera;
}

} // namespace dicot::test
