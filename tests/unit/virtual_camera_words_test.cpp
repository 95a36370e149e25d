// What a virtual camera says of itself, and how it is spoken to.
#include "controls.h"
#include "descriptors.h"
#include "negotiation.h"
#include "options.h"
#include "wire.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <string>

namespace dicot::usbip {
namespace {

Bytes bytes(std::initializer_list<int> values)
{
    Bytes all;
    for (const int value : values)
        all.push_back(static_cast<std::uint8_t>(value));
    return all;
}

// Numbers of 32 bits, big-endian.
Bytes words(std::initializer_list<std::uint32_t> values)
{
    Bytes all;
    for (const std::uint32_t value : values)
        for (const int shift : {24, 16, 8, 0})
            all.push_back(static_cast<std::uint8_t>(value >> shift));
    return all;
}

CameraModel two_formats()
{
    CameraModel camera;
    camera.formats = {{Pixels::kYuyv, {{640, 480, 614400}, {1280, 720, 1843200}}},
                      {Pixels::kMjpeg, {{640, 480, 90000}}}};
    return camera;
}

// The two messages and the field tables of the kernel's Documentation/usb/usbip_protocol.rst.
TEST(UsbipWire, reads_the_kernels_interrupt_transfer)
{
    const Bytes message = words({1, 0xd05, 0x0001000f, 1, 1, 0x200, 0x40, 0xffffffff, 0, 4, 0, 0});
    const Read read = read_request(message);
    EXPECT_EQ(read.consumed, 48u);
    ASSERT_TRUE(read.request.has_value());
    EXPECT_EQ(read.request->sequence, 0xd05u);
    EXPECT_TRUE(read.request->in);
    EXPECT_EQ(read.request->endpoint, 1u);
    EXPECT_EQ(read.request->length, 0x40u);
    EXPECT_TRUE(read.request->packets.empty());
}

TEST(UsbipWire, waits_for_the_last_byte_of_data_and_packets)
{
    Bytes message = words({1, 7, 0, 0, 3, 0, 5, 0, 2, 1, 0, 0});
    message.insert(message.begin() + 48, {1, 2, 3, 4, 5});
    const Bytes packets = words({0, 3, 0, 0, 3, 2, 0, 0});
    message[35] = 2; // two packets
    message.insert(message.end(), packets.begin(), packets.end());
    for (std::size_t size = 0; size < message.size(); ++size) {
        const Read part = read_request(std::span(message).first(size));
        EXPECT_EQ(part.consumed, 0u) << size;
        EXPECT_FALSE(part.broken) << size;
    }
}

TEST(UsbipWire, reads_packets_behind_the_data)
{
    Bytes message = words({1, 7, 0, 0, 3, 0, 5, 0, 2, 1, 0, 0, 0x01020304});
    message.push_back(5);
    const Bytes packets = words({0, 3, 0, 0, 3, 2, 0, 0});
    message.insert(message.end(), packets.begin(), packets.end());
    const Read read = read_request(message);
    ASSERT_TRUE(read.request.has_value());
    EXPECT_EQ(read.consumed, message.size());
    EXPECT_EQ(read.request->out, bytes({1, 2, 3, 4, 5}));
    ASSERT_EQ(read.request->packets.size(), 2u);
    EXPECT_EQ(read.request->packets[1].offset, 3u);
    EXPECT_EQ(read.request->packets[1].length, 2u);
}

TEST(UsbipWire, refuses_what_no_host_asks_for)
{
    EXPECT_TRUE(read_request(words({9, 7, 0, 0, 3, 0, 5, 0, 2, 1, 0, 0})).broken);
    EXPECT_TRUE(read_request(words({1, 7, 0, 1, 3, 0, 0x7fffffff, 0, 2, 1, 0, 0})).broken);
    EXPECT_TRUE(read_request(words({1, 7, 0, 1, 3, 0, 5, 0, 2000, 1, 0, 0})).broken);
}

TEST(UsbipWire, writes_returns_as_the_kernels_table_tells)
{
    Request request;
    request.sequence = 0x1234;
    EXPECT_EQ(write_unlinked(request, -ECONNRESET),
              words({4, 0x1234, 0, 0, 0, 0xffffff98, 0, 0, 0, 0, 0, 0})); // 104 is ECONNRESET
    const IsoPacket packets[] = {{0, 16, 2, 0}, {16, 16, 0, -71}};
    Bytes expected = words({3, 0x1234, 0, 0, 0, 0, 2, 0, 2, 1, 0, 0});
    expected.insert(expected.end(), {8, 9});
    const Bytes tail = words({0, 16, 2, 0, 16, 16, 0, 0xffffffb9});
    expected.insert(expected.end(), tail.begin(), tail.end());
    const Bytes data = {8, 9};
    EXPECT_EQ(write_return(request, 0, 2, data, packets), expected);
}

// USB 2.0 table 9-8, byte by byte.
TEST(CameraDescriptors, device_is_a_composite_of_high_speed)
{
    CameraModel camera = two_formats();
    camera.product_id = 0x0102;
    EXPECT_EQ(device_descriptor(camera),
              bytes({18, 1, 0x00, 0x02, 0xEF, 2, 1, 64, 0x09, 0x12, 0x02, 0x01, 0x00, 0x01, 1, 2, 3, 1}));
}

struct Walk
{
    int descriptors = 0;
    int alternates = 0;
    Bytes endpoint_words; ///< low byte of wMaxPacketSize, high byte, of each video endpoint
    int control_total = 0, control_walked = 0, stream_total = 0, stream_walked = 0;
};

Walk walk(const Bytes& all)
{
    Walk seen;
    int subclass = 0;
    for (std::size_t at = 0; at < all.size(); at += all[at]) {
        EXPECT_GE(all[at], 2u);
        EXPECT_LE(at + all[at], all.size());
        if (all[at] < 2 || at + all[at] > all.size())
            return seen;
        ++seen.descriptors;
        if (all[at + 1] == 4) {
            subclass = all[at + 6];
            seen.alternates += subclass == 2 ? 1 : 0;
        } else if (all[at + 1] == 5 && all[at + 2] == 0x81) {
            seen.endpoint_words.push_back(all[at + 4]);
            seen.endpoint_words.push_back(all[at + 5]);
        } else if (all[at + 1] == 0x24) {
            const int total =
                all[at + 2] == 1 ? all[at + (subclass == 1 ? 5u : 4u)] | all[at + (subclass == 1 ? 6u : 5u)] << 8 : 0;
            (subclass == 1 ? seen.control_total : seen.stream_total) += total;
            (subclass == 1 ? seen.control_walked : seen.stream_walked) += all[at];
        }
    }
    return seen;
}

TEST(CameraDescriptors, lengths_add_up)
{
    for (const bool bulk : {false, true}) {
        CameraModel camera = two_formats();
        camera.bulk = bulk;
        const Bytes all = configuration_descriptor(camera);
        EXPECT_EQ(static_cast<std::size_t>(all[2] | all[3] << 8), all.size());
        const Walk seen = walk(all);
        EXPECT_EQ(seen.control_total, seen.control_walked);
        EXPECT_EQ(seen.stream_total, seen.stream_walked);
        EXPECT_GT(seen.stream_walked, 0);
        EXPECT_EQ(seen.alternates, bulk ? 1 : 7);
    }
}

// wMaxPacketSize, USB 2.0 table 9-13: bits 0 .. 10 bytes, bits 11 .. 12 further packets.
TEST(CameraDescriptors, high_bandwidth_stands_in_the_packet_size)
{
    CameraModel camera = two_formats();
    camera.alternates = {{128, 1}, {1024, 3}};
    EXPECT_EQ(walk(configuration_descriptor(camera)).endpoint_words, bytes({0x80, 0x00, 0x00, 0x14}));
    camera.bulk = true;
    EXPECT_EQ(walk(configuration_descriptor(camera)).endpoint_words, bytes({0x00, 0x02}));
}

TEST(CameraDescriptors, names_keep_control_characters_and_wide_letters)
{
    CameraModel camera = two_formats();
    camera.product = "\x1b[\xc3\xa9\xe2\x82\xac";
    EXPECT_EQ(string_descriptor(camera, 2), bytes({10, 3, 0x1b, 0, '[', 0, 0xe9, 0, 0xac, 0x20}));
    EXPECT_TRUE(string_descriptor(camera, 9).empty());
    camera.product = std::string(500, 'x');
    EXPECT_EQ(string_descriptor(camera, 2).size(), 254u);
}

Bytes wish(int format, int frame, std::uint32_t interval)
{
    Bytes data(26);
    data[2] = static_cast<std::uint8_t>(format);
    data[3] = static_cast<std::uint8_t>(frame);
    for (std::size_t i = 0; i < 4; ++i)
        data[4 + i] = static_cast<std::uint8_t>(interval >> (8 * i));
    return data;
}

constexpr int kProbe = 1, kCommit = 2, kSetCur = 1, kGetCur = 0x81;

TEST(CameraNegotiation, mends_a_probe_to_the_nearest_mode)
{
    const CameraModel camera = two_formats();
    Negotiation negotiation(camera);
    EXPECT_EQ(negotiation.request(kProbe, kSetCur, wish(7, 9, 1'000'000)).status, 0);
    const Bytes got = negotiation.request(kProbe, kGetCur, {}).data;
    ASSERT_EQ(got.size(), 34u);
    EXPECT_EQ(got[2], 1);
    EXPECT_EQ(got[3], 1);
    EXPECT_EQ(got[4] | got[5] << 8 | got[6] << 16, 666'667); // 10 fps lies nearer to 15 than to 5, in time
    EXPECT_EQ(got[18] | got[19] << 8 | got[20] << 16, 614'400);
}

TEST(CameraNegotiation, commits_what_exists_and_nothing_else)
{
    const CameraModel camera = two_formats();
    Negotiation negotiation(camera);
    EXPECT_EQ(negotiation.request(kCommit, kSetCur, wish(1, 2, 2'000'000)).status, 0);
    EXPECT_EQ(negotiation.committed().frame_bytes, 1'843'200u);
    EXPECT_EQ(negotiation.request(kCommit, kSetCur, wish(3, 1, 2'000'000)).status, -EPIPE);
    EXPECT_EQ(negotiation.request(kCommit, kSetCur, wish(1, 1, 2'000'001)).status, -EPIPE);
    EXPECT_EQ(negotiation.request(kCommit, kSetCur, Bytes(25)).status, -EPIPE);
    EXPECT_EQ(negotiation.committed().frame_bytes, 1'843'200u);
}

// 614400 bytes in 200 ms are 384 a microframe of 125 us, 396 with the header: 512 fits. At 30 fps: 2305 and 12.
TEST(CameraNegotiation, asks_for_the_bandwidth_that_the_mode_needs)
{
    CameraModel camera = two_formats();
    EXPECT_EQ(payload_bytes(camera, 614'400, 2'000'000), 512u);
    EXPECT_EQ(payload_bytes(camera, 614'400, 333'333), 3072u);
    EXPECT_EQ(payload_bytes(camera, 1'843'200, 333'333), 3072u); // more than there is
    camera.payload_policy = PayloadPolicy::kMost;
    EXPECT_EQ(payload_bytes(camera, 100, 2'000'000), 3072u);
    camera.payload_policy = PayloadPolicy::kFixed;
    camera.payload_bytes = 777;
    EXPECT_EQ(payload_bytes(camera, 614'400, 2'000'000), 777u);
}

// Selectors and reasons: UVC 1.1 tables 4-5, 4-7, A-12, A-13.
TEST(CameraControls, keep_the_rules_of_the_class)
{
    constexpr int kBrightness = 2, kExposureMode = 2, kExposureTime = 4, kGetLen = 0x85, kGetInfo = 0x86,
                  kGetMin = 0x82;
    Controls controls;
    EXPECT_EQ(controls.request(kProcessingUnit, kBrightness, kGetMin, {}).data, bytes({0xC0, 0xFF})); // -64
    EXPECT_EQ(controls.request(kProcessingUnit, kBrightness, kSetCur, bytes({0xF9, 0xFF})).status, 0);
    EXPECT_EQ(controls.request(kProcessingUnit, kBrightness, kGetCur, {}).data, bytes({0xF9, 0xFF}));
    EXPECT_EQ(controls.request(kProcessingUnit, kBrightness, kGetLen, {}).data, bytes({2, 0}));

    EXPECT_EQ(controls.request(kProcessingUnit, kBrightness, kSetCur, bytes({65, 0})).status, -EPIPE);
    EXPECT_EQ(controls.last_error(), 4); // out of range
    EXPECT_EQ(controls.request(kProcessingUnit, 99, kGetCur, {}).status, -EPIPE);
    EXPECT_EQ(controls.last_error(), 6); // no such control
    EXPECT_EQ(controls.request(9, kBrightness, kGetCur, {}).status, -EPIPE);
    EXPECT_EQ(controls.last_error(), 5); // no such unit

    EXPECT_EQ(controls.request(kCameraTerminal, kExposureTime, kGetInfo, {}).data, bytes({7}));
    EXPECT_EQ(controls.request(kCameraTerminal, kExposureTime, kSetCur, bytes({100, 0, 0, 0})).status, -EPIPE);
    EXPECT_EQ(controls.last_error(), 2); // wrong state: the automatism holds it
    EXPECT_EQ(controls.request(kCameraTerminal, kExposureMode, kSetCur, bytes({2})).status, -EPIPE);
    EXPECT_EQ(controls.request(kCameraTerminal, kExposureMode, kSetCur, bytes({1})).status, 0);
    EXPECT_EQ(controls.request(kCameraTerminal, kExposureTime, kSetCur, bytes({100, 0, 0, 0})).status, 0);
    EXPECT_EQ(controls.request(kCameraTerminal, kExposureTime, kGetInfo, {}).data, bytes({3}));
}

// UVC 1.1 tables 3-6 and 3-8: exposure mode 1, time 3, focus 5, auto focus 17; brightness 0, contrast 1, white balance
// 6, gain 9, power line 10, white balance automatism 12.
TEST(CameraControls, stand_in_the_bitmaps_of_their_entities)
{
    EXPECT_EQ(control_bits(kCameraTerminal), (std::array<std::uint8_t, 3>{0x2A, 0x00, 0x02}));
    EXPECT_EQ(control_bits(kProcessingUnit), (std::array<std::uint8_t, 3>{0x43, 0x16, 0x00}));
}

TEST(CameraOptions, read_what_a_camera_is)
{
    const char* const line[] = {
        "--bus-bytes", "6000",
        "--camera",    "name=left,frames=f,transfer=bulk,fps=25/5,alternates=192/3x1024,payload=most,port=3",
        "--plan",      "p"};
    const Result<Options> options = read_options(line);
    ASSERT_TRUE(options.ok()) << options.status().message();
    EXPECT_EQ(options.value().bus_bytes, 6000);
    const CameraWish& wish = options.value().cameras.at(0);
    EXPECT_EQ(wish.port, 3);
    EXPECT_TRUE(wish.model.bulk);
    EXPECT_EQ(wish.model.rates_fps, (std::vector<int>{25, 5}));
    EXPECT_EQ(wish.model.alternates.back().bytes_a_microframe(), 3072);
}

TEST(CameraOptions, refuse_what_is_no_camera)
{
    for (const char* camera :
         {"name=left", "frames=f,fps=0", "frames=f,alternates=4x1024", "frames=f,alternates=512/192", "frames=f,port=8",
          "frames=f,payload=few", "frames=f,colour=red"}) {
        const char* const line[] = {"--camera", camera};
        const Result<Options> options = read_options(line);
        EXPECT_EQ(options.status().fault(), Fault::kUsage) << camera;
    }
    const char* const twins[] = {"--camera", "frames=f,name=a,port=0", "--camera", "frames=f,name=a,port=1"};
    EXPECT_EQ(read_options(twins).status().fault(), Fault::kUsage);
    const char* const same_port[] = {"--camera", "frames=f,port=1", "--camera", "frames=f,port=1"};
    EXPECT_EQ(read_options(same_port).status().fault(), Fault::kUsage);
    EXPECT_EQ(read_options({}).status().fault(), Fault::kUsage);
}

} // namespace
} // namespace dicot::usbip
