#include "dicot/uvc_parse/payload.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

namespace dicot {
namespace {

using Fed = FrameAssembler::Fed;
using Bytes = std::vector<std::byte>;

constexpr int kFid = 1;
constexpr int kEof = 2;
constexpr int kErr = 0x40;

Bytes of(std::initializer_list<int> values)
{
    Bytes bytes;
    for (const int value : values)
        bytes.push_back(static_cast<std::byte>(value));
    return bytes;
}

Bytes payload(int flags, std::initializer_list<int> data)
{
    Bytes bytes = of({2, 0x80 | flags});
    const Bytes tail = of(data);
    bytes.insert(bytes.end(), tail.begin(), tail.end());
    return bytes;
}

/// An assembler with a buffer that is full of 0xEE, and has a guard behind it.
class Payload : public testing::Test
{
protected:
    void begin(const PayloadRules& rules, std::size_t room = 16)
    {
        buffer_.assign(room + 8, std::byte{0xEE});
        room_ = room;
        assembler_.restart(rules);
        give_buffer();
    }
    void give_buffer() { assembler_.use(std::span{buffer_}.first(room_)); }
    Fed feed(const Bytes& bytes, bool last = true, std::int64_t at_us = 1000)
    {
        const Fed fed = assembler_.feed(bytes, last, at_us);
        EXPECT_TRUE(std::all_of(buffer_.begin() + static_cast<std::ptrdiff_t>(room_), buffer_.end(),
                                [](std::byte one) { return one == std::byte{0xEE}; }));
        return fed;
    }
    Bytes frame() const
    {
        return {buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(assembler_.closed().bytes)};
    }
    void expect_whole(std::initializer_list<int> data) const
    {
        EXPECT_EQ(assembler_.closed().verdict, FrameVerdict::kWhole) << assembler_.closed().flaw;
        EXPECT_STREQ(assembler_.closed().flaw, "");
        EXPECT_EQ(frame(), of(data));
    }
    void expect_torn(const std::string& flaw) const
    {
        EXPECT_EQ(assembler_.closed().verdict, FrameVerdict::kTorn);
        EXPECT_EQ(assembler_.closed().flaw, flaw);
    }

    FrameAssembler assembler_;
    Bytes buffer_;
    std::size_t room_ = 0;
};

TEST_F(Payload, PacketsOfOneFrameIdBecomeAFrameAtItsEnd)
{
    begin({.exact_bytes = 4});
    EXPECT_EQ(feed(payload(0, {1, 2})), Fed::kMore);
    EXPECT_EQ(feed({}), Fed::kMore);
    EXPECT_EQ(feed(payload(0, {3})), Fed::kMore);
    EXPECT_EQ(feed(payload(kEof, {4})), Fed::kClosed);
    expect_whole({1, 2, 3, 4});
}

TEST_F(Payload, AnEndWithoutDataEndsTheFrame)
{
    begin({.exact_bytes = 2});
    EXPECT_EQ(feed(payload(kFid, {1, 2})), Fed::kMore);
    EXPECT_EQ(feed(payload(kFid | kEof, {})), Fed::kClosed);
    expect_whole({1, 2});
}

TEST_F(Payload, AFrameWhoseEndWasLostIsClosedByTheNextOne)
{
    begin({.exact_bytes = 2});
    EXPECT_EQ(feed(payload(0, {1, 2})), Fed::kMore);
    EXPECT_EQ(feed(payload(kFid, {3})), Fed::kClosedBefore);
    expect_whole({1, 2}); // all its bytes came: only the mark was lost
    give_buffer();
    EXPECT_EQ(feed(payload(kFid, {3})), Fed::kMore);
    EXPECT_EQ(feed(payload(kFid | kEof, {4})), Fed::kClosed);
    expect_whole({3, 4});
}

TEST_F(Payload, OnePacketCanCloseTwoFrames)
{
    begin({.exact_bytes = 1});
    EXPECT_EQ(feed(payload(0, {1})), Fed::kMore);
    EXPECT_EQ(feed(payload(kFid | kEof, {2})), Fed::kClosedBefore);
    expect_whole({1});
    give_buffer();
    EXPECT_EQ(feed(payload(kFid | kEof, {2})), Fed::kClosed);
    expect_whole({2});
}

TEST_F(Payload, TooFewBytesTear)
{
    begin({.exact_bytes = 4});
    feed(payload(0, {1, 2}));
    EXPECT_EQ(feed(payload(kEof, {3})), Fed::kClosed);
    expect_torn("3 of 4 bytes");
    EXPECT_EQ(frame(), of({1, 2, 3}));
}

TEST_F(Payload, TooManyBytesTearAndNeverLeaveTheBuffer)
{
    begin({.exact_bytes = 4}, 4);
    feed(payload(0, {1, 2, 3}));
    EXPECT_EQ(feed(payload(kEof, {4, 5, 6})), Fed::kClosed);
    expect_torn("6 of 4 bytes");
    EXPECT_EQ(frame(), of({1, 2, 3, 4}));
    begin({}, 4);
    EXPECT_EQ(feed(payload(kEof, {1, 2, 3, 4, 5})), Fed::kClosed);
    expect_torn("5 bytes, room for 4");
}

TEST_F(Payload, TheErrorBitTearsAndItsDataAreNotKept)
{
    begin({.exact_bytes = 2});
    feed(payload(0, {1}));
    feed(payload(kErr, {9}));
    EXPECT_EQ(feed(payload(kEof, {2})), Fed::kClosed);
    expect_torn("error bit");
    EXPECT_EQ(frame(), of({1, 2}));
    give_buffer();
    EXPECT_EQ(feed(payload(kFid | kEof, {3, 4})), Fed::kClosed);
    expect_whole({3, 4});
}

TEST_F(Payload, AnErrorWithTheEndBitStillEndsTheFrame)
{
    begin({.exact_bytes = 1});
    feed(payload(0, {1}));
    EXPECT_EQ(feed(payload(kEof | kErr, {})), Fed::kClosed);
    expect_torn("error bit");
}

TEST_F(Payload, HeadersThatAreNoneTearTheFrame)
{
    for (const Bytes& bad : {of({1}), of({2}), of({0, 0x80, 5}), of({1, 0x80, 5}), of({4, 0x80, 5}), of({255, 0x80})}) {
        begin({.exact_bytes = 2});
        feed(payload(0, {1}));
        EXPECT_EQ(feed(bad), Fed::kMore);
        EXPECT_EQ(feed(payload(kEof, {2})), Fed::kClosed);
        expect_torn("bad payload header");
    }
}

TEST_F(Payload, ALongHeaderIsSkippedAsFarAsItSays)
{
    begin({.exact_bytes = 1});
    EXPECT_EQ(feed(of({14, 0x80 | kEof, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 77})), Fed::kClosed);
    expect_whole({77});
}

TEST_F(Payload, AFrameWithoutBytesIsTorn)
{
    begin({.exact_bytes = 2});
    EXPECT_EQ(feed(payload(kEof, {})), Fed::kClosed);
    expect_torn("no bytes");
    give_buffer();
    begin({.jpeg = true});
    EXPECT_EQ(feed(payload(kEof, {})), Fed::kClosed);
    expect_torn("no bytes");
}

TEST_F(Payload, IdleTalkBehindAnEndIsNoFrame)
{
    begin({.exact_bytes = 1});
    EXPECT_EQ(feed(payload(kEof, {1})), Fed::kClosed);
    give_buffer();
    EXPECT_EQ(feed(payload(0, {})), Fed::kMore);
    EXPECT_EQ(feed(payload(kEof, {})), Fed::kMore);
    EXPECT_FALSE(assembler_.under_way());
    EXPECT_EQ(feed(payload(kFid | kEof, {2})), Fed::kClosed);
    expect_whole({2});
}

TEST_F(Payload, DataBehindAnEndWithTheSameFrameIdAreATornFrame)
{
    begin({.exact_bytes = 1});
    feed(payload(kFid | kEof, {1}));
    give_buffer();
    feed(payload(kEof, {2}));
    expect_whole({2});
    give_buffer();
    EXPECT_EQ(feed(payload(kEof, {3})), Fed::kClosed);
    expect_torn("frame id did not toggle");
    give_buffer();
    EXPECT_EQ(feed(payload(kFid | kEof, {4})), Fed::kClosed);
    expect_whole({4});
}

TEST_F(Payload, ACameraThatNeverTogglesIsBelievedAfterFourFrames)
{
    begin({.exact_bytes = 1});
    for (int i = 0; i < 8; ++i) {
        give_buffer();
        ASSERT_EQ(feed(payload(kEof, {i})), Fed::kClosed);
        EXPECT_EQ(assembler_.closed().verdict, i == 0 || i >= 4 ? FrameVerdict::kWhole : FrameVerdict::kTorn) << i;
    }
}

TEST_F(Payload, AFrameIdThatJumpsInsideAFrameMakesTwoTornFrames)
{
    begin({.exact_bytes = 4});
    feed(payload(0, {1, 2}));
    EXPECT_EQ(feed(payload(kFid, {3})), Fed::kClosedBefore);
    expect_torn("2 of 4 bytes");
    give_buffer();
    feed(payload(kFid, {3}));
    EXPECT_EQ(feed(payload(kEof, {4})), Fed::kClosedBefore);
    expect_torn("1 of 4 bytes");
    give_buffer();
    EXPECT_EQ(feed(payload(kEof, {4})), Fed::kClosed);
    expect_torn("1 of 4 bytes");
}

TEST_F(Payload, ALossBetweenFramesTearsTheNextOneAlone)
{
    begin({.exact_bytes = 1});
    feed(payload(kEof, {1}));
    expect_whole({1});
    assembler_.lose("lost packet");
    give_buffer();
    feed(payload(kFid | kEof, {2}));
    expect_torn("lost packet");
    give_buffer();
    feed(payload(kEof, {3}));
    expect_whole({3});
}

TEST_F(Payload, TheFirstFlawIsTheOneThatIsTold)
{
    begin({.exact_bytes = 9});
    feed(payload(0, {1}));
    assembler_.lose("lost packet");
    feed(payload(kErr, {}));
    feed(payload(kEof, {2}));
    expect_torn("lost packet");
}

TEST_F(Payload, JpegNeedsItsMarkersAndMayBePaddedWithZeros)
{
    const auto verdict_of = [&](std::initializer_list<int> data) {
        begin({.jpeg = true});
        EXPECT_EQ(feed(payload(kEof, data)), Fed::kClosed);
        return std::string{assembler_.closed().flaw};
    };
    EXPECT_EQ(verdict_of({0xFF, 0xD8, 1, 0xFF, 0xD9}), "");
    EXPECT_EQ(verdict_of({0xFF, 0xD8, 1, 0xFF, 0xD9, 0, 0, 0}), "");
    EXPECT_EQ(verdict_of({0xFF, 0xD8, 1, 2, 3}), "no JPEG end marker");
    EXPECT_EQ(verdict_of({0xFF, 0xD8, 1, 0xFF, 0xD9, 7}), "no JPEG end marker");
    EXPECT_EQ(verdict_of({0xFF, 0xD8}), "no JPEG end marker");
    EXPECT_EQ(verdict_of({0, 0, 0}), "no JPEG start marker");
    EXPECT_EQ(verdict_of({0xFF}), "no JPEG start marker");
    EXPECT_EQ(verdict_of({1, 0xFF, 0xD8, 0xFF, 0xD9}), "no JPEG start marker");
}

TEST_F(Payload, WithoutABufferFramesAreFollowedAndNotKept)
{
    begin({.exact_bytes = 1});
    assembler_.use({});
    EXPECT_EQ(feed(payload(0, {1})), Fed::kMore);
    give_buffer(); // too late for this one
    EXPECT_EQ(feed(payload(kEof, {})), Fed::kClosed);
    EXPECT_EQ(assembler_.closed().bytes, 0u);
    EXPECT_EQ(assembler_.closed().verdict, FrameVerdict::kTorn);
    give_buffer();
    EXPECT_EQ(feed(payload(kFid | kEof, {2})), Fed::kClosed);
    expect_whole({2});
}

TEST_F(Payload, CancellingEndsWhatIsUnderWay)
{
    begin({.exact_bytes = 2});
    EXPECT_EQ(assembler_.cancel("the stream was stopped"), Fed::kMore);
    feed(payload(0, {1}));
    EXPECT_EQ(assembler_.cancel("the stream was stopped"), Fed::kClosed);
    EXPECT_EQ(assembler_.closed().verdict, FrameVerdict::kCancelled);
    EXPECT_STREQ(assembler_.closed().flaw, "the stream was stopped");
    EXPECT_EQ(assembler_.closed().bytes, 1u);
}

TEST_F(Payload, ABulkPayloadMaySpanTransfersAndHasOneHeader)
{
    begin({.exact_bytes = 6, .most_payload_bytes = 64});
    EXPECT_EQ(feed(of({2, 0x80, 1, 2}), false), Fed::kMore);
    EXPECT_EQ(feed(of({3, 4}), false), Fed::kMore);
    EXPECT_EQ(feed({}, true), Fed::kMore); // a zero-length packet ends the payload
    EXPECT_EQ(feed(of({2, 0x80 | kEof, 5}), false), Fed::kMore);
    EXPECT_EQ(feed(of({6}), true), Fed::kClosed);
    expect_whole({1, 2, 3, 4, 5, 6});
}

TEST_F(Payload, ABulkPayloadOfFullLengthNeedsNoShortTransfer)
{
    begin({.exact_bytes = 4, .most_payload_bytes = 4});
    EXPECT_EQ(feed(of({2, 0x80, 1, 2}), false), Fed::kMore);
    EXPECT_EQ(feed(of({2, 0x80 | kEof, 3, 4}), false), Fed::kClosed);
    expect_whole({1, 2, 3, 4});
}

TEST_F(Payload, ABadBulkHeaderSpoilsItsPayloadAlone)
{
    begin({.exact_bytes = 2, .most_payload_bytes = 64});
    feed(of({2, 0x80, 1}), true);
    feed(of({1, 0x80, 9, 9}), false);
    feed(of({2, 0x80 | kEof, 9}), true); // still the payload without a header
    EXPECT_EQ(feed(of({2, 0x80 | kEof, 2}), true), Fed::kClosed);
    expect_torn("bad payload header");
    EXPECT_EQ(frame(), of({1, 2}));
}

TEST_F(Payload, TheStartOfTheFrameComesFromTheDevicesClock)
{
    begin({.exact_bytes = 2, .clock_hz = 1'000'000});
    // PTS 1000, STC 4000: 3 ms old when it arrives at 50 ms.
    feed(of({12, 0x8C, 0xE8, 3, 0, 0, 0xA0, 0x0F, 0, 0, 0, 0, 1}), true, 50'000);
    EXPECT_EQ(feed(of({12, 0x8C | kEof, 0xE8, 3, 0, 0, 0xFF, 0x0F, 0, 0, 0, 0, 2}), true, 60'000), Fed::kClosed);
    expect_whole({1, 2});
    EXPECT_EQ(assembler_.closed().start_us, 47'000);
}

TEST_F(Payload, WithoutTheDevicesClockTheFirstDataCount)
{
    begin({.exact_bytes = 2, .clock_hz = 1'000'000});
    feed(payload(0, {}), true, 10'000);
    feed(payload(0, {1}), true, 20'000);
    feed(payload(kEof, {2}), true, 30'000);
    EXPECT_EQ(assembler_.closed().start_us, 20'000);
}

TEST_F(Payload, ClockBitsWithoutRoomForAClockAreNotRead)
{
    begin({.exact_bytes = 1, .clock_hz = 1'000'000});
    EXPECT_EQ(feed(of({6, 0x8C | kEof, 1, 2, 3, 4, 9}), true, 10'000), Fed::kClosed);
    expect_whole({9});
    EXPECT_EQ(assembler_.closed().start_us, 10'000);
}

} // namespace
} // namespace dicot
