// Frames of a virtual camera as a host sees them: put together again by the rules of UVC 1.1, 2.4.3, in the shortest
// words.
#include "camera.h"
#include "fault.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <vector>

namespace dicot::usbip {
namespace {

constexpr int kWidth = 64, kHeight = 40, kFrameBytes = kWidth * kHeight * 2;
constexpr Microseconds kStart = 1'000'000, kInterval = 200'000;

std::uint32_t number_at(const Bytes& bytes, std::size_t at)
{
    return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 | std::uint32_t{bytes[at + 2]} << 8 |
           bytes[at + 3];
}

/// What a payload header says, and what follows it.
struct Payload
{
    int header_bytes = 0, bits = 0;
    Bytes data;
};

struct Frame
{
    Bytes data;
    bool error = false, ended = false;
    int id = -1;
};

/// A host with one camera: sends requests, keeps answers.
class Host
{
public:
    explicit Host(bool bulk, int bus_bytes = 0, int payload = 0) : bus_(bus_bytes)
    {
        for (int k = 0; k < 3; ++k) {
            Bytes picture;
            for (int i = 0; i < kFrameBytes; ++i)
                picture.push_back(static_cast<std::uint8_t>(i * 7 + i / 256 + k * 101));
            files_.push_back(picture);
            folder_.write("64x40_" + std::to_string(k) + ".yuyv", picture);
        }
        EXPECT_TRUE(frames_.open(folder_.path("")).ok());
        CameraModel model;
        model.bulk = bulk;
        model.formats = frames_.formats();
        model.rates_fps = {5};
        if (payload > 0) {
            model.payload_policy = PayloadPolicy::kFixed;
            model.payload_bytes = payload;
        }
        camera_ = std::make_unique<Camera>(
            model, Camera::Surroundings{frames_, bus_, [this](Bytes answer) { answers_.push_back(std::move(answer)); },
                                        [this](const std::string& event) { log_ += event + "\n"; }});
        camera_->power_on();
    }

    void plan(const std::string& line)
    {
        Result<Line> read = read_line(line, 1);
        ASSERT_TRUE(read.ok()) << read.status().message();
        ASSERT_TRUE(read.value().fault.has_value());
        camera_->add_fault(*read.value().fault);
    }
    int control(int type, int request, int value, int index, Bytes out = {})
    {
        return camera_
            ->control({static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(request),
                       static_cast<std::uint8_t>(value & 255), static_cast<std::uint8_t>(value >> 8),
                       static_cast<std::uint8_t>(index & 255), static_cast<std::uint8_t>(index >> 8), 0, 0},
                      out, kStart)
            .status;
    }
    int start(int alternate)
    {
        Bytes commit(26);
        commit[2] = commit[3] = 1;
        commit[4] = 0x80, commit[5] = 0x84, commit[6] = 0x1e; // 2000000 x 100 ns
        EXPECT_EQ(control(0x21, 1, 0x0200, 1, commit), 0);
        return alternate > 0 ? control(0x01, 11, alternate, 1) : 0;
    }
    void submit_iso(int packets, std::uint32_t packet_bytes)
    {
        Request request;
        request.in = true;
        request.endpoint = kVideoEndpoint;
        request.sequence = ++sequence_;
        for (int i = 0; i < packets; ++i)
            request.packets.push_back({static_cast<std::uint32_t>(i) * packet_bytes, packet_bytes, 0, 0});
        request.length = static_cast<std::uint32_t>(packets) * packet_bytes;
        camera_->take(std::move(request), kStart);
    }
    void submit_bulk(std::uint32_t room)
    {
        Request request;
        request.in = true;
        request.endpoint = kVideoEndpoint;
        request.sequence = ++sequence_;
        request.length = room;
        camera_->take(std::move(request), kStart);
    }

    /// The payloads of all isochronous answers so far; lost packets are left out.
    std::vector<Payload> iso_payloads() const
    {
        std::vector<Payload> all;
        for (const Bytes& answer : answers_) {
            const std::uint32_t packets = number_at(answer, 32);
            std::size_t at = 48;
            for (std::size_t i = 0; i < packets; ++i) {
                const std::size_t size = number_at(answer, 48 + number_at(answer, 24) + i * 16 + 8);
                all.push_back(payload(Bytes(answer.begin() + static_cast<std::ptrdiff_t>(at),
                                            answer.begin() + static_cast<std::ptrdiff_t>(at + size))));
                at += size;
            }
        }
        std::erase_if(all, [](const Payload& one) { return one.header_bytes == 0 && one.data.empty(); });
        return all;
    }
    static Payload payload(const Bytes& bytes)
    {
        if (bytes.size() < 2)
            return {};
        const std::size_t head = std::min<std::size_t>(bytes[0], bytes.size());
        return {bytes[0], bytes[1], Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(head), bytes.end())};
    }
    static std::vector<Frame> frames(const std::vector<Payload>& payloads)
    {
        std::vector<Frame> all;
        for (const Payload& one : payloads) {
            if (all.empty() || all.back().id != (one.bits & 1) || all.back().ended)
                all.push_back({{}, false, false, one.bits & 1});
            all.back().data.insert(all.back().data.end(), one.data.begin(), one.data.end());
            all.back().error = all.back().error || (one.bits & 0x40) != 0;
            all.back().ended = (one.bits & 2) != 0;
        }
        return all;
    }
    std::vector<Frame> two_iso_frames()
    {
        EXPECT_EQ(start(1), 0);
        for (const Microseconds now : {kStart, kStart + kInterval}) {
            submit_iso(64, 192);
            EXPECT_FALSE(camera_->serve(now).has_value());
        }
        return frames(iso_payloads());
    }

    test::TempFolder folder_;
    std::vector<Bytes> files_;
    FrameFolder frames_;
    Bus bus_;
    std::unique_ptr<Camera> camera_;
    std::vector<Bytes> answers_;
    std::string log_;
    std::uint32_t sequence_ = 0;
};

TEST(VirtualCamera, isochronous_frames_are_the_files)
{
    Host host(false);
    const std::vector<Frame> got = host.two_iso_frames();
    ASSERT_EQ(got.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(got[k].data, host.files_[k]);
        EXPECT_TRUE(got[k].ended);
    }
    EXPECT_NE(got[0].id, got[1].id);
    for (const Payload& one : host.iso_payloads()) {
        EXPECT_EQ(one.header_bytes, 12);
        EXPECT_EQ(one.bits & 0x8C, 0x8C); // time stamps, end of header
        EXPECT_LE(one.data.size(), 180u);
    }
}

TEST(VirtualCamera, a_frame_waits_until_it_is_due)
{
    Host host(false);
    ASSERT_EQ(host.start(1), 0);
    host.submit_iso(64, 192);
    EXPECT_FALSE(host.camera_->serve(kStart).has_value());
    EXPECT_EQ(host.answers_.size(), 1u);
    host.submit_iso(64, 192);
    EXPECT_FALSE(host.camera_->serve(kStart + VideoStream::kIdle - 1).has_value());
    EXPECT_EQ(host.answers_.size(), 1u);
    EXPECT_FALSE(host.camera_->serve(kStart + VideoStream::kIdle).has_value());
    ASSERT_EQ(host.answers_.size(), 2u);
    EXPECT_EQ(number_at(host.answers_[1], 24), 0u); // no byte
    EXPECT_EQ(number_at(host.answers_[1], 32), 64u);
}

// 5120 bytes in payloads of at most 1000: five of 988 and one of 180, each a transfer that ends short or full.
TEST(VirtualCamera, bulk_payloads_end_their_transfers)
{
    for (const std::uint32_t room : {1000u, 500u, 4096u}) {
        Host host(true, 0, 1000);
        ASSERT_EQ(host.start(0), 0);
        for (int i = 0; i < 20; ++i)
            host.submit_bulk(room);
        EXPECT_FALSE(host.camera_->serve(kStart).has_value());
        std::vector<Payload> payloads;
        Bytes open;
        for (const Bytes& answer : host.answers_) {
            const std::uint32_t size = number_at(answer, 24);
            open.insert(open.end(), answer.begin() + 48, answer.end());
            if (size < room || open.size() == 1000) {
                payloads.push_back(Host::payload(open));
                open.clear();
            }
        }
        ASSERT_EQ(payloads.size(), 6u) << room;
        const std::vector<Frame> frames = Host::frames(payloads);
        ASSERT_EQ(frames.size(), 1u) << room;
        EXPECT_EQ(frames[0].data, host.files_[0]) << room;
        EXPECT_EQ(payloads[5].data.size(), 180u);
    }
}

TEST(VirtualCamera, a_cleared_halt_ends_a_bulk_stream_that_has_begun)
{
    Host host(true);
    ASSERT_EQ(host.start(0), 0);
    const auto clear_halt = [&] { return host.control(0x02, 1, 0, 0x81); };
    EXPECT_EQ(clear_halt(), 0);
    host.submit_bulk(16384);
    EXPECT_FALSE(host.camera_->serve(kStart).has_value());
    EXPECT_EQ(host.answers_.size(), 1u);
    EXPECT_EQ(clear_halt(), 0);
    host.submit_bulk(16384);
    EXPECT_FALSE(host.camera_->serve(kStart + kInterval).has_value());
    EXPECT_EQ(host.answers_.size(), 1u);
}

// A payload of 512 bytes of a full 1024 fills the host's transfer: only an empty one tells that it is over.
TEST(VirtualCamera, a_bulk_payload_that_fills_a_transfer_ends_with_an_empty_one)
{
    Host host(true, 0, 1024);
    host.plan("left * * truncate byte=500");
    ASSERT_EQ(host.start(0), 0);
    host.submit_bulk(512);
    host.submit_bulk(512);
    EXPECT_FALSE(host.camera_->serve(kStart).has_value());
    ASSERT_EQ(host.answers_.size(), 2u);
    EXPECT_EQ(number_at(host.answers_[0], 24), 512u);
    EXPECT_EQ(number_at(host.answers_[1], 24), 0u);
}

struct Spoiling
{
    const char* fault;
    int bytes;
    bool error, ended;
};

TEST(VirtualCamera, faults_do_to_a_frame_what_their_names_say)
{
    const Spoiling cases[] = {
        {"short packet=2 bytes=100", kFrameBytes - 100, false, true},
        {"drop packet=2 count=3", kFrameBytes - 3 * 180, false, true},
        {"err packet=2", kFrameBytes, true, true},
        {"truncate byte=1000", 1000, false, true},
        {"overlong bytes=50", kFrameBytes + 50, false, true},
        {"zero_frame", 0, false, true},
        {"no_eof", kFrameBytes, false, false},
    };
    for (const Spoiling& one : cases) {
        Host host(false);
        host.plan(std::string("left 1 0 ") + one.fault);
        const std::vector<Frame> got = host.two_iso_frames();
        ASSERT_EQ(got.size(), 2u) << one.fault;
        EXPECT_EQ(got[0].data.size(), static_cast<std::size_t>(one.bytes)) << one.fault;
        EXPECT_EQ(got[0].error, one.error) << one.fault;
        EXPECT_EQ(got[0].ended, one.ended) << one.fault;
        EXPECT_EQ(got[1].data, host.files_[1]) << one.fault;
        EXPECT_NE(host.log_.find("stream 1 frame 0: "), std::string::npos) << one.fault;
    }
}

TEST(VirtualCamera, header_faults_touch_their_packet_alone)
{
    Host host(false);
    host.plan("left 1 0 bad_header packet=4 length=200");
    host.plan("left 1 0 wrong_fid packet=6");
    (void)host.two_iso_frames();
    const std::vector<Payload> payloads = host.iso_payloads();
    for (std::size_t i = 0; i < 20; ++i) {
        EXPECT_EQ(payloads[i].header_bytes, i == 4 ? 200 : 12) << i;
        EXPECT_EQ(payloads[i].bits & 1, i == 6 ? 1 : 0) << i;
    }
}

TEST(VirtualCamera, the_cable_goes_at_the_planned_byte)
{
    for (const int byte : {0, 1, 180, 181, 1000, kFrameBytes}) {
        Host host(false);
        host.plan("left 1 0 unplug back_ms=30 byte=" + std::to_string(byte));
        ASSERT_EQ(host.start(1), 0);
        host.submit_iso(64, 192);
        EXPECT_EQ(host.camera_->serve(kStart), std::optional<Microseconds>(30'000));
        std::size_t got = 0;
        for (const Payload& one : host.iso_payloads())
            got += one.data.size();
        EXPECT_EQ(got, static_cast<std::size_t>(byte));
    }
}

TEST(VirtualCamera, a_silent_stream_is_cured_by_a_restart)
{
    Host host(false);
    host.plan("left 1 1 silent");
    EXPECT_EQ(host.two_iso_frames().size(), 1u);
    host.answers_.clear();
    EXPECT_EQ(host.control(0x01, 11, 0, 1), 0);
    EXPECT_EQ(host.two_iso_frames().size(), 2u);
}

TEST(VirtualCamera, a_hang_is_cured_by_a_reset_alone)
{
    Host host(false);
    host.plan("left 1 1 hang");
    EXPECT_EQ(host.two_iso_frames().size(), 1u);
    host.answers_.clear();
    EXPECT_EQ(host.control(0x01, 11, 0, 1), 0);
    EXPECT_EQ(host.two_iso_frames().size(), 0u);
    host.answers_.clear();
    EXPECT_EQ(host.control(0x00, 9, 1, 0), 0); // SET_CONFIGURATION 1
    EXPECT_EQ(host.two_iso_frames().size(), 2u);
}

TEST(VirtualCamera, settings_that_do_not_fit_are_refused_as_a_host_controller_would)
{
    Bus bus(6000);
    EXPECT_TRUE(bus.reserve("left", 3072));
    EXPECT_FALSE(bus.reserve("right", 3072));
    EXPECT_TRUE(bus.reserve("right", 2048));
    EXPECT_TRUE(bus.reserve("left", 1024));
    EXPECT_TRUE(bus.reserve("right", 3072));

    Host host(false, 3000);
    EXPECT_EQ(host.start(6), -ENOSPC); // 3 x 1024
    EXPECT_EQ(host.start(5), 0);
    host.plan("left control refuse_interface errno=32 times=2");
    EXPECT_EQ(host.start(5), -EPIPE);
    EXPECT_EQ(host.start(1), -EPIPE);
    EXPECT_EQ(host.start(5), 0);
}

TEST(VirtualCamera, ends_transfers_that_the_host_takes_back)
{
    Host host(false);
    host.submit_iso(8, 192);
    Request unlink;
    unlink.kind = Request::Kind::kUnlink;
    unlink.sequence = 99;
    unlink.victim = 1;
    host.camera_->take(unlink, kStart);
    host.camera_->take(unlink, kStart);
    ASSERT_EQ(host.answers_.size(), 2u);
    EXPECT_EQ(static_cast<std::int32_t>(number_at(host.answers_[0], 20)), -ECONNRESET);
    EXPECT_EQ(number_at(host.answers_[1], 20), 0u);
}

TEST(VirtualCamera, waits_for_the_transfer_when_its_unlink_is_ahead_of_it)
{
    Host host(false);
    host.submit_iso(8, 192);
    Request unlink;
    unlink.kind = Request::Kind::kUnlink;
    unlink.sequence = 98;
    unlink.victim = 2;
    host.camera_->take(unlink, kStart);
    EXPECT_TRUE(host.answers_.empty());
    host.submit_iso(8, 192);
    ASSERT_EQ(host.answers_.size(), 1u); // for the unlink alone
    EXPECT_EQ(number_at(host.answers_[0], 4), 98u);
    EXPECT_EQ(static_cast<std::int32_t>(number_at(host.answers_[0], 20)), -ECONNRESET);
    EXPECT_FALSE(host.camera_->serve(kStart + VideoStream::kIdle).has_value());
    for (const Bytes& answer : host.answers_)
        EXPECT_NE(number_at(answer, 4), 2u);

    // What was submitted before the camera was plugged in anew does not come again.
    host.camera_->power_on();
    host.answers_.clear();
    host.camera_->take(unlink, kStart);
    ASSERT_EQ(host.answers_.size(), 1u);
    EXPECT_EQ(number_at(host.answers_[0], 20), 0u);
    host.answers_.clear();
    unlink.victim = 3;
    host.camera_->take(unlink, kStart);
    EXPECT_TRUE(host.answers_.empty());
    ASSERT_TRUE(host.camera_->deadline().has_value());
    EXPECT_FALSE(host.camera_->serve(*host.camera_->deadline()).has_value());
    ASSERT_EQ(host.answers_.size(), 1u);
    EXPECT_EQ(number_at(host.answers_[0], 20), 0u);
}

TEST(FaultPlan, reads_every_place)
{
    const Result<Line> frame = read_line("left next 12 drop packet=3 count=0", 1);
    ASSERT_TRUE(frame.ok()) << frame.status().message();
    EXPECT_TRUE(frame.value().fault->next_stream);
    EXPECT_EQ(frame.value().fault->frame, 12);
    EXPECT_EQ((*frame.value().fault)["errno"], 71);
    EXPECT_FALSE(touches_packet(*frame.value().fault, 2));
    EXPECT_TRUE(touches_packet(*frame.value().fault, 900));

    const Result<Line> control = read_line("right control stall unit=2 request=get_cur times=3", 2);
    ASSERT_TRUE(control.ok()) << control.status().message();
    EXPECT_EQ(control.value().fault->left, 3);
    EXPECT_EQ((*control.value().fault)["request"], 0x81);

    const Result<Line> plug = read_line("left plug product text=a\\x1b[1m\\sb", 3);
    ASSERT_TRUE(plug.ok()) << plug.status().message();
    EXPECT_EQ(plug.value().fault->text, "a\x1b[1m b");

    EXPECT_TRUE(read_line("left now unplug", 4).value().order.has_value());
    EXPECT_FALSE(read_line("  # nothing", 5).value().fault.has_value());
}

TEST(FaultPlan, refuses_lines_that_would_do_nothing)
{
    for (const char* line :
         {"left 0 1 err", "left 1 -2 err", "left 1 1 stall", "left control err", "left 1 1 err packt=1",
          "left 1 1 err packet=x", "left now explode", "left 1 1", "left", "left 1 1 err text=a"})
        EXPECT_EQ(read_line(line, 7).status().fault(), Fault::kConfig) << line;
}

TEST(FrameFolder, refuses_what_is_no_frame)
{
    test::TempFolder folder;
    EXPECT_EQ(FrameFolder().open(folder.path("")).fault(), Fault::kNoInput);
    EXPECT_EQ(FrameFolder().open(folder.path("none")).fault(), Fault::kNoInput);
    folder.write("4x2_0.yuyv", test::Bytes(15));
    EXPECT_EQ(FrameFolder().open(folder.path("")).fault(), Fault::kBadData);
}

TEST(FrameFolder, orders_formats_and_sizes_and_repeats_frames)
{
    test::TempFolder folder;
    folder.write("8x2_0.yuyv", test::Bytes(32, 1));
    folder.write("4x2_1.yuyv", test::Bytes(16, 2));
    folder.write("4x2_0.yuyv", test::Bytes(16, 3));
    folder.write("4x2_0.jpg", test::Bytes(9, 4));
    folder.write("note.txt", test::Bytes(1, 5));
    FrameFolder frames;
    ASSERT_TRUE(frames.open(folder.path("")).ok());
    const std::vector<Format> formats = frames.formats();
    ASSERT_EQ(formats.size(), 2u);
    ASSERT_EQ(formats[0].modes.size(), 2u);
    EXPECT_EQ(formats[0].modes[0].width, 4);
    EXPECT_EQ(formats[1].modes[0].largest_frame_bytes, 9u);
    EXPECT_EQ(frames.frame(0, 0, 0)[0], 3);
    EXPECT_EQ(frames.frame(0, 0, 3)[0], 2);
    EXPECT_EQ(frames.frame(1, 0, 5)[0], 4);
}

} // namespace
} // namespace dicot::usbip
