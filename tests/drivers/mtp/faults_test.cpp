// Hosts that change their mind, lie or go away, and objects that do.
#include "board.h"

namespace dicot {
namespace {

using test::Bytes;
using test::MemoryShelf;
using test::MtpBoard;
using test::Wire;

TEST_F(MtpBoard, EveryLengthAroundPacketsAndPiecesArrives)
{
    open();
    for (const std::size_t around : {512u, 1024u, 131'072u, 262'144u, 393'216u, 524'288u})
        for (const std::size_t size : {around - 13, around - 12, around - 11, around, around + 1}) {
            shelf.file(0x74, kSnapshot, "f.bin", size);
            const Heard heard = ask(0x1009, {0x74});
            EXPECT_EQ(heard.announced, size + 12);
            ASSERT_EQ(heard.data, MemoryShelf::content(0x74, 0, size)) << size;
            EXPECT_EQ(heard.code, 0x2001);
        }
    shelf.file(0x74, kSnapshot, "f.bin", 0);
    const Heard none = ask(0x1009, {0x74});
    EXPECT_TRUE(none.had_data);
    EXPECT_EQ(none.announced, 12u);
    EXPECT_EQ(none.code, 0x2001);
}

TEST_F(MtpBoard, ManyObjectsPassThroughTheSameRoom)
{
    open();
    std::size_t names = 0;
    for (std::uint32_t i = 0; i < 100'000; ++i) {
        shelf.file(0x1000 + i, kSnapshot, "f" + std::to_string(i), i);
        names += 2 * (std::to_string(i).size() + 2) + 1;
    }
    const Heard handles = ask(0x1007, {0xFFFFFFFF, 0, kSnapshot});
    EXPECT_EQ(handles.announced, 12u + 4 + 4 * 100'003);
    ASSERT_EQ(handles.data.size(), 4u + 4 * 100'003);
    EXPECT_EQ(number(handles.data, 4 + 4 * 100'002, 4), 0x1000u + 99'999);
    const Heard list = ask(0x9805, {kSnapshot, 0x3000, 0xDC07, 0, 1});
    constexpr std::size_t kTwoMore = 2 * 8 + (1 + 2 * 10) + (1 + 2 * 11); // cloud.drc, SHA256SUMS
    EXPECT_EQ(list.announced, 12 + 4 + 100'000 * 8 + names + kTwoMore);
    EXPECT_EQ(list.data.size() + 12, list.announced);
    EXPECT_EQ(number(list.data, 0, 4), 100'002u);
}

TEST_F(MtpBoard, CancelledTransferGetsNoResponseAndTheNextOneWorks)
{
    open();
    for (int at = 0; at < 4; ++at) {
        link.cancel_at_send = at;
        const Heard heard = ask(0x1009, {kCloud});
        EXPECT_EQ(heard.code, 0) << at;
    }
    EXPECT_EQ(responder.counts().cancelled, 4u);
    EXPECT_EQ(responder.counts().objects_sent, 1u) << "the last one had its data, and lost its response";
}

TEST_F(MtpBoard, ResetEndsTheSession)
{
    open();
    link.cancel_at_send = 1;
    link.reset_with_cancel = true;
    EXPECT_EQ(ask(0x1009, {kCloud}).code, 0);
    EXPECT_FALSE(responder.counts().session_open);
    link.cancel_at_send = -1;
    link.reset();
    open();
    EXPECT_EQ(ask(0x1010).code, 0x2001);
    EXPECT_EQ(ask(0x1004).code, 0x2003);
}

TEST_F(MtpBoard, UnpluggedHostEndsTheCallAndTheSession)
{
    open();
    link.unplug_at_send = 1;
    link.say(Wire::block(1, 0x1009, 9, {kCloud}));
    EXPECT_EQ(responder.serve_one().fault(), Fault::kUnavailable);
    EXPECT_FALSE(responder.counts().session_open);
    EXPECT_EQ(responder.serve_one().fault(), Fault::kUnavailable);
}

TEST_F(MtpBoard, FileThatGoesMidwayEndsEarlyAndIsTold)
{
    open();
    constexpr std::size_t kPiece = 131'072;
    shelf.read_fault = Fault::kNoInput;
    shelf.read_fault_at = 2 * kPiece; // the third piece of the transfer fails
    const Heard heard = ask(0x1009, {kCloud});
    EXPECT_EQ(heard.announced, 300'012u);
    EXPECT_EQ(heard.data, MemoryShelf::content(kCloud, 0, 2 * kPiece - 12));
    EXPECT_EQ(heard.code, 0x2007);
    EXPECT_EQ(responder.counts().objects_sent, 0u);
}

TEST_F(MtpBoard, FileThatIsNotThereAnyMoreIsToldWithoutData)
{
    open();
    shelf.read_fault = Fault::kNoInput;
    const Heard gone = ask(0x1009, {kCloud});
    EXPECT_EQ(gone.code, 0x2009);
    EXPECT_FALSE(gone.had_data);
    shelf.read_fault = Fault::kIoError;
    const Heard broken = ask(0x95C1, {kCloud, 0, 0, 1000});
    EXPECT_EQ(broken.code, 0x2002);
    EXPECT_FALSE(broken.had_data);
    shelf.read_fault = Fault::kOk;
    EXPECT_EQ(ask(0x1009, {kCloud}).data, MemoryShelf::content(kCloud, 0, 300'000));
}

TEST_F(MtpBoard, DataThatNobodyAskedForIsPassedOver)
{
    open();
    for (const std::size_t size : {0u, 100u, 500u, 700u, 300'000u}) {
        link.say(Wire::container(2, 0x1004, 99, Bytes(size)));
        if ((size + 12) % 512 == 0)
            link.say({});
        EXPECT_TRUE(responder.serve_one().ok());
        while (responder.serve_one().ok()) {
        }
        EXPECT_TRUE(link.take_sent().empty());
        EXPECT_TRUE(link.all_taken());
        open();
    }
}

TEST_F(MtpBoard, CommandInPlaceOfDataIsAnswered)
{
    open();
    link.say(Wire::block(1, 0x9D02, 70, {}));
    link.say(Wire::block(1, 0x1004, 71, {}));
    EXPECT_TRUE(responder.serve_one().ok());
    EXPECT_TRUE(link.take_sent().empty());
    EXPECT_TRUE(responder.serve_one().ok());
    EXPECT_EQ(hear(0x1004, 71).code, 0x2001);
    EXPECT_TRUE(shelf.marked.empty());
}

TEST_F(MtpBoard, DataOfAnotherTransactionIsRefused)
{
    open();
    const Bytes marks = Wire().u32(1).u64(1).zeros(32).bytes();
    link.say(Wire::block(1, 0x9D02, 80, {}));
    link.say(Wire::container(2, 0x9D02, 81, marks));
    EXPECT_TRUE(responder.serve_one().ok());
    EXPECT_EQ(hear(0x9D02, 80).code, 0x2004);
    link.say(Wire::block(1, 0x9D02, 82, {}));
    link.say(Wire::container(2, 0x9D03, 82, marks));
    EXPECT_TRUE(responder.serve_one().ok());
    EXPECT_EQ(hear(0x9D02, 82).code, 0x2004);
    EXPECT_TRUE(shelf.marked.empty());
}

TEST_F(MtpBoard, DataThatEndsEarlyOrLateIsRefused)
{
    open();
    Bytes early = Wire::container(2, 0x9D02, 90, Wire().u32(2).zeros(80).bytes());
    early.resize(early.size() - 40);
    link.say(Wire::block(1, 0x9D02, 90, {}));
    link.say(early);
    EXPECT_TRUE(responder.serve_one().ok());
    EXPECT_EQ(hear(0x9D02, 90).code, 0x2007);
    Bytes late = Wire::container(2, 0x9D02, 91, Wire().u32(1).zeros(40).bytes());
    late.resize(late.size() + 40);
    link.say(Wire::block(1, 0x9D02, 91, {}));
    link.say(late);
    EXPECT_TRUE(responder.serve_one().ok());
    EXPECT_EQ(hear(0x9D02, 91).code, 0xA806);
    EXPECT_TRUE(shelf.marked.empty());
}

TEST_F(MtpBoard, DataOfWholePacketsIsTakenWithAndWithoutAnEndMark)
{
    open();
    Wire marks;
    marks.u32(38); // 12 + 4 + 38 * 40 = 3 packets
    for (unsigned i = 0; i < 38; ++i)
        marks.u64(i).zeros(32);
    EXPECT_EQ(ask_with_data(0x9D02, marks.bytes()).code, 0x2001);
    EXPECT_EQ(shelf.marked.size(), 38u);
    EXPECT_EQ(ask_with_data(0x9D02, marks.bytes()).code, 0x2001);
    link.say({});
    EXPECT_TRUE(responder.serve_one().ok());
    EXPECT_EQ(ask_with_data(0x9D02, marks.bytes()).code, 0x2001);
    EXPECT_EQ(shelf.marked.size(), 3u * 38);
}

TEST_F(MtpBoard, BrokenCommandsAreAnsweredOnceAndGarbageIsNot)
{
    open();
    Bytes lie = Wire::block(1, 0x1004, 60, {1, 2});
    lie[0] = std::byte{24}; // says more than there is
    link.say(lie);
    EXPECT_TRUE(responder.serve_one().ok());
    EXPECT_EQ(hear(0x1004, 60).code, 0x2002);
    link.say(Wire::block(1, 0x1004, 61, {1, 2, 3, 4, 5, 6}));
    EXPECT_TRUE(responder.serve_one().ok());
    EXPECT_EQ(hear(0x1004, 61).code, 0x2002);
    for (const Bytes& garbage : {Bytes{}, Bytes(1), Bytes(11), Bytes(12), Bytes(511, std::byte{0xFF}),
                                 Wire::block(3, 0x2001, 62, {}), Wire::block(4, 0x4001, 62, {})}) {
        link.say(garbage);
        EXPECT_TRUE(responder.serve_one().ok());
        EXPECT_TRUE(link.take_sent().empty()) << garbage.size();
    }
    EXPECT_EQ(ask(0x1004).code, 0x2001);
}

TEST_F(MtpBoard, TellsWhatCameAndWentWhileTheHostIsSilent)
{
    shelf.changes = {{kLeft, true}};
    link.idle_times = 1;
    EXPECT_TRUE(responder.serve_one().ok());
    EXPECT_TRUE(link.events.empty()) << "nobody listens without a session";
    open();
    shelf.changes = {{0x80, true}, {kLeft, false}};
    link.idle_times = 1;
    EXPECT_TRUE(responder.serve_one().ok());
    ASSERT_EQ(link.events.size(), 2u);
    EXPECT_EQ(link.events[0], Wire::block(4, 0x4002, 0xFFFFFFFF, {0x80}));
    EXPECT_EQ(link.events[1], Wire::block(4, 0x4003, 0xFFFFFFFF, {kLeft}));
}

TEST_F(MtpBoard, FloodOfChangesEndsInOneEvent)
{
    open();
    for (std::uint32_t i = 0; i < 10'000; ++i)
        shelf.changes.push_back({0x1000 + i, false});
    link.idle_times = 1;
    EXPECT_TRUE(responder.serve_one().ok());
    ASSERT_EQ(link.events.size(), 65u);
    EXPECT_EQ(link.events[64], Wire::block(4, 0x400C, 0xFFFFFFFF, {0x00010001}));
}

TEST_F(MtpBoard, BusyHostHearsOfChangesToo)
{
    open();
    const int before = shelf.refreshed;
    for (int i = 0; i < 1024; ++i)
        ASSERT_EQ(ask(0x1008, {kLeft}).code, 0x2001);
    EXPECT_EQ(shelf.refreshed - before, 4);
    ask(0x1007, {0xFFFFFFFF, 0, kBoard});
    EXPECT_EQ(shelf.refreshed - before, 5) << "a list is as of now";
}

} // namespace
} // namespace dicot
