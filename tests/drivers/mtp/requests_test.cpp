// Each operation, as a host hears it.
#include "board.h"

namespace dicot {
namespace {

using test::Bytes;
using test::MemoryShelf;
using test::MtpBoard;
using test::Wire;

TEST_F(MtpBoard, TellsWhatItIsBeforeASession)
{
    const Heard heard = ask(0x1001);
    EXPECT_EQ(heard.code, 0x2001);
    EXPECT_EQ(heard.announced, heard.data.size() + 12);
    Wire expected;
    expected.u16(100).u32(6).u16(100).text("microsoft.com: 1.0; dicot.example: 1.0;").u16(0);
    const std::vector<std::uint16_t> operations{0x1001, 0x1002, 0x1003, 0x1004, 0x1005, 0x1006, 0x1007, 0x1008,
                                                0x1009, 0x100A, 0x1010, 0x1014, 0x1015, 0x101B, 0x95C1, 0x9801,
                                                0x9802, 0x9803, 0x9805, 0x9810, 0x9D01, 0x9D02, 0x9D03};
    expected.u32(operations.size());
    for (const std::uint16_t one : operations)
        expected.u16(one);
    expected.u32(3).u16(0x4002).u16(0x4003).u16(0x400C);
    expected.u32(2).u16(0xD402).u16(0xD407);
    expected.u32(0);
    expected.u32(4).u16(0x3000).u16(0x3001).u16(0x3801).u16(0x380B);
    expected.text("dicot").text("stereo").text("1.2").text("B3");
    EXPECT_EQ(heard.data, expected.bytes());
}

TEST_F(MtpBoard, OpensOneSessionAtATime)
{
    EXPECT_EQ(ask(0x1004).code, 0x2003);
    EXPECT_EQ(ask(0x1002, {0}).code, 0x201D);
    EXPECT_FALSE(responder.counts().session_open);
    EXPECT_EQ(ask(0x1002, {0x51}).code, 0x2001);
    EXPECT_TRUE(responder.counts().session_open);
    const Heard again = ask(0x1002, {0x52});
    EXPECT_EQ(again.code, 0x201E);
    EXPECT_EQ(again.parameters, std::vector<std::uint32_t>{0x51});
    EXPECT_EQ(ask(0x1003).code, 0x2001);
    EXPECT_EQ(ask(0x1003).code, 0x2003);
    for (int i = 0; i < 1000; ++i) {
        ASSERT_EQ(ask(0x1002, {1}).code, 0x2001);
        ASSERT_EQ(ask(0x1003).code, 0x2001);
    }
    EXPECT_EQ(responder.counts().sessions, 1001u);
}

TEST_F(MtpBoard, HasOneStorageToReadFrom)
{
    open();
    EXPECT_EQ(ask(0x1004).data, Wire().u32(1).u32(0x00010001).bytes());
    const Bytes expected = Wire()
                               .u16(1)
                               .u16(2)
                               .u16(1)
                               .u64(64'000'000'000)
                               .u64(5'000'000'000)
                               .u32(0xFFFFFFFF)
                               .text("bench 3")
                               .text("bench 3")
                               .bytes();
    EXPECT_EQ(ask(0x1005, {0x00010001}).data, expected);
    const Heard other = ask(0x1005, {0x00020001});
    EXPECT_EQ(other.code, 0x2008);
    EXPECT_FALSE(other.had_data);
}

TEST_F(MtpBoard, ListsHandlesByParentAndFormat)
{
    open();
    const auto list = [&](std::uint32_t format, std::uint32_t parent, std::uint32_t storage = 0xFFFFFFFF) {
        const Heard heard = ask(0x1007, {storage, format, parent});
        EXPECT_EQ(heard.code, 0x2001);
        const Heard counted = ask(0x1006, {storage, format, parent});
        EXPECT_EQ(counted.parameters, std::vector<std::uint32_t>{number(heard.data, 0, 4)});
        EXPECT_FALSE(counted.had_data);
        return heard.data;
    };
    EXPECT_EQ(list(0, 0xFFFFFFFF), Wire().u32(1).u32(kBoard).bytes());
    EXPECT_EQ(list(0, kBoard, 0x00010001), Wire().u32(1).u32(kDay).bytes());
    EXPECT_EQ(list(0, kSnapshot), Wire().u32(3).u32(kLeft).u32(kCloud).u32(kSums).bytes());
    EXPECT_EQ(list(0, 0), Wire().u32(6).u32(kBoard).u32(kSnapshot).u32(kDay).u32(kLeft).u32(kCloud).u32(kSums).bytes());
    EXPECT_EQ(list(0x3001, 0), Wire().u32(3).u32(kBoard).u32(kSnapshot).u32(kDay).bytes());
    EXPECT_EQ(list(0x380B, kSnapshot), Wire().u32(1).u32(kLeft).bytes());
    EXPECT_EQ(list(0xFFFFFFFF, 0), Wire().u32(1).u32(kLeft).bytes()) << "every picture";
    EXPECT_EQ(list(0x3801, 0), Wire().u32(0).bytes());
    EXPECT_EQ(ask(0x1007, {1, 0, 0}).code, 0x2008);
    EXPECT_EQ(ask(0x1007, {0xFFFFFFFF, 0, 0x99}).code, 0x2009);
    EXPECT_EQ(ask(0x1007, {0xFFFFFFFF, 0, kLeft}).code, 0x201A);
}

TEST_F(MtpBoard, DescribesFilesAndFolders)
{
    open();
    const auto described = [](std::uint16_t format, std::uint32_t size, std::uint32_t parent, std::uint16_t association,
                              std::string_view name) {
        return Wire()
            .u32(0x00010001)
            .u16(format)
            .u16(1)
            .u32(size)
            .u16(0)
            .zeros(6 * 4)
            .u32(parent)
            .u16(association)
            .u32(0)
            .u32(0)
            .text(name)
            .text("20260301T120000Z")
            .text("20260301T120000Z")
            .text("")
            .bytes();
    };
    EXPECT_EQ(ask(0x1008, {kBoard}).data, described(0x3001, 0, 0, 1, "bench-3"));
    EXPECT_EQ(ask(0x1008, {kLeft}).data, described(0x380B, 1000, kSnapshot, 0, "left.png"));
    EXPECT_EQ(ask(0x1008, {kCloud}).data, described(0x3000, 300'000, kSnapshot, 0, "cloud.drc"));
    shelf.file(0x73, kSnapshot, "film.jpg", 0xFFFFFFFF, kNoonUs);
    EXPECT_EQ(ask(0x1008, {0x73}).data, described(0x3801, 0xFFFFFFFF, kSnapshot, 0, "film.jpg"));
    shelf.file(0x73, kSnapshot, "film.jpg", 0x1'0000'0005, kNoonUs);
    EXPECT_EQ(ask(0x1008, {0x73}).data, described(0x3801, 0xFFFFFFFF, kSnapshot, 0, "film.jpg"));
    EXPECT_EQ(ask(0x1008, {0x99}).code, 0x2009);
}

TEST_F(MtpBoard, GivesWholeFiles)
{
    open();
    for (const mtp::Handle handle : {kLeft, kCloud, kSums}) {
        const std::size_t size = handle == kLeft ? 1000 : handle == kCloud ? 300'000 : 160;
        const Heard heard = ask(0x1009, {handle});
        EXPECT_EQ(heard.code, 0x2001);
        EXPECT_EQ(heard.announced, size + 12);
        EXPECT_EQ(heard.data, MemoryShelf::content(handle, 0, size));
    }
    EXPECT_EQ(responder.counts().objects_sent, 3u);
    EXPECT_EQ(ask(0x1009, {kSnapshot}).code, 0x2009);
    EXPECT_EQ(ask(0x1009, {0x99}).code, 0x2009);
    EXPECT_EQ(ask(0x100A, {kLeft}).code, 0x2010);
    EXPECT_EQ(ask(0x100A, {0x99}).code, 0x2009);
}

TEST_F(MtpBoard, GivesPartsWithTheirSize)
{
    open();
    const auto part = [&](std::uint32_t offset, std::uint32_t most, std::uint32_t expected) {
        const Heard heard = ask(0x101B, {kCloud, offset, most});
        EXPECT_EQ(heard.code, 0x2001);
        EXPECT_EQ(heard.parameters, std::vector<std::uint32_t>{expected});
        EXPECT_EQ(heard.data, MemoryShelf::content(kCloud, offset, expected));
    };
    part(0, 300'000, 300'000);
    part(0, 0xFFFFFFFF, 300'000);
    part(1, 131'072, 131'072);
    part(299'999, 10, 1);
    part(300'000, 10, 0);
    part(400'000, 10, 0);
    part(0, 0, 0);
    EXPECT_EQ(responder.counts().objects_sent, 3u) << "a file is sent when its end is";
}

TEST_F(MtpBoard, ReachesBeyondFourGib)
{
    open();
    constexpr std::uint64_t kBytes = 0x2'0000'0100;
    shelf.file(0x73, kSnapshot, "film.bin", kBytes, kNoonUs);
    const Heard heard = ask(0x95C1, {0x73, 0x80, 2, 0x1000});
    EXPECT_EQ(heard.code, 0x2001);
    EXPECT_EQ(heard.parameters, std::vector<std::uint32_t>{0x80});
    EXPECT_EQ(heard.data, MemoryShelf::content(0x73, 0x2'0000'0080, 0x80));
    const Heard size = ask(0x9803, {0x73, 0xDC04});
    EXPECT_EQ(size.data, Wire().u64(kBytes).bytes());
}

TEST_F(MtpBoard, ObjectOfFourGibIsSentWithoutALength)
{
    open();
    shelf.file(0x73, kSnapshot, "film.bin", 0xFFFFFFFF - 12, kNoonUs);
    link.cancel_at_send = 3;
    const Heard cancelled = ask(0x1009, {0x73});
    EXPECT_EQ(cancelled.code, 0);
    EXPECT_EQ(number(link.unfinished(), 0, 4), 0xFFFFFFFFu);
    EXPECT_EQ(link.unfinished().size(), 3u * 131'072);
}

TEST_F(MtpBoard, DescribesItsOwnProperties)
{
    open();
    EXPECT_EQ(ask(0x1015, {0xD402}).data, Wire().text("bench-3").bytes());
    EXPECT_EQ(ask(0x1014, {0xD402}).data,
              Wire().u16(0xD402).u16(0xFFFF).u8(0).text("bench-3").text("bench-3").u8(0).bytes());
    EXPECT_EQ(ask(0x1014, {0xD407}).data, Wire().u16(0xD407).u16(6).u8(0).u32(1).u32(1).u8(0).bytes());
    EXPECT_EQ(ask(0x1014, {0x5001}).code, 0x200A);
    EXPECT_EQ(ask(0x1015, {0xFFFFFFFF}).code, 0x200A);
    EXPECT_EQ(ask(0x1015, {0x1D402}).code, 0x200A);
}

TEST_F(MtpBoard, ListsSnapshotsForDicotPull)
{
    open();
    for (std::int64_t i = 1; i <= 3000; ++i)
        shelf.notes.push_back({i, kNoonUs, 1000, static_cast<std::uint32_t>(i << 4), 3, i % 2 == 0, {}});
    const auto note = [](std::uint64_t i) {
        return Wire().u64(i).u64(kNoonUs).u64(1000).u32(i << 4).u16(3).u16(i % 2 == 0).zeros(32).bytes();
    };
    EXPECT_EQ(ask(0x9D01, {2, 0, 2}).data, Wire().u32(2).add(note(2)).add(note(3)).bytes());
    EXPECT_EQ(ask(0x9D01, {2999, 0, 0}).data, Wire().u32(2).add(note(2999)).add(note(3000)).bytes());
    EXPECT_EQ(ask(0x9D01, {0, 1, 0}).data, Wire().u32(0).bytes());
    const Heard most = ask(0x9D01, {0, 0, 0xFFFFFFFF});
    EXPECT_EQ(most.announced, 12u + 4 + 2047 * 64);
    EXPECT_EQ(most.data.size(), 4u + 2047 * 64);
    EXPECT_EQ(number(most.data, 0, 4), 2047u);
    EXPECT_EQ(ask(0x9D01, {0, 0x80000000, 0}).code, 0x201D);
}

TEST_F(MtpBoard, TakesMarksAndTime)
{
    open();
    Wire marks;
    marks.u32(512);
    for (unsigned i = 0; i < 512; ++i)
        marks.u64(i + 1).add(Bytes(32, static_cast<std::byte>(i)));
    EXPECT_EQ(ask_with_data(0x9D02, marks.bytes()).code, 0x2001);
    ASSERT_EQ(shelf.marked.size(), 512u);
    EXPECT_EQ(shelf.marked[511].sequence, 512);
    EXPECT_EQ(shelf.marked[3].sums[31], std::byte{3});
    EXPECT_EQ(responder.counts().marked, 512u);
    EXPECT_EQ(ask_with_data(0x9D03, Wire().u64(kNoonUs).bytes()).code, 0x2001);
    ASSERT_EQ(shelf.offered.size(), 1u);
    EXPECT_EQ(shelf.offered[0].now_us, kNoonUs);

    const auto fails = [&](Fault fault, std::uint16_t code) {
        shelf.mark_fault = fault;
        EXPECT_EQ(ask_with_data(0x9D02, Wire().u32(0).bytes()).code, code);
    };
    fails(Fault::kTryAgain, 0x2019);
    fails(Fault::kUsage, 0x200F);
    fails(Fault::kNoInput, 0x2009);
    fails(Fault::kBadData, 0xA806);
    fails(Fault::kIoError, 0x2002);
    EXPECT_EQ(responder.counts().marked, 512u);
}

TEST_F(MtpBoard, RefusesDatasetsOfItsOwnThatAreNotSound)
{
    open();
    const std::vector<Bytes> bad{Bytes{},
                                 Wire().u32(1).bytes(),
                                 Wire().u32(1).zeros(41).bytes(),
                                 Wire().u32(2).zeros(40).bytes(),
                                 Wire().u32(513).zeros(513 * 40).bytes(),
                                 Wire().u32(0xFFFFFFFF).zeros(40).bytes(),
                                 Bytes(300'000)};
    for (const Bytes& one : bad)
        EXPECT_EQ(ask_with_data(0x9D02, one).code, 0xA806) << one.size();
    EXPECT_EQ(ask_with_data(0x9D03, Bytes(7)).code, 0xA806);
    EXPECT_EQ(ask_with_data(0x9D03, Bytes(9)).code, 0xA806);
    EXPECT_TRUE(shelf.marked.empty());
    EXPECT_TRUE(shelf.offered.empty());
    EXPECT_EQ(ask(0x1004).code, 0x2001);
}

TEST_F(MtpBoard, NoOperationOfAllWrites)
{
    open();
    for (std::uint32_t code = 0; code <= 0xFFFF; ++code) {
        if (code == 0x9D02 || code == 0x9D03)
            continue;
        const auto operation = static_cast<std::uint16_t>(code);
        const std::uint32_t id = next_transaction++;
        link.say(Wire::block(1, operation, id, {kLeft, 0, 0xFFFFFFFF, 0, 0}));
        link.say(Wire::container(2, operation, id, Bytes(60)));
        while (!link.all_taken())
            ASSERT_TRUE(responder.serve_one().ok());
        const Heard heard = hear(operation, id);
        ASSERT_NE(heard.code, 0) << std::hex << code;
        const bool listed = (code >= 0x1001 && code <= 0x100A) || code == 0x1010 || code == 0x1014 || code == 0x1015 ||
                            code == 0x101B || code == 0x95C1 || (code >= 0x9801 && code <= 0x9803) || code == 0x9805 ||
                            code == 0x9810 || code == 0x9D01;
        EXPECT_TRUE(listed || (heard.code != 0x2001 && !heard.had_data)) << std::hex << code;
        if (!responder.counts().session_open)
            open();
    }
    EXPECT_TRUE(shelf.marked.empty());
    EXPECT_TRUE(shelf.offered.empty());
    EXPECT_EQ(ask(0x1009, {kLeft}).data, MemoryShelf::content(kLeft, 0, 1000));
}

TEST_F(MtpBoard, SaysReadOnlyToWhoeverWouldWrite)
{
    open();
    for (const auto code :
         std::initializer_list<std::uint16_t>{0x100B, 0x100F, 0x1012, 0x1019, 0x101A, 0x95C3, 0x95C4, 0x95C5})
        EXPECT_EQ(ask(code, {kLeft}).code, 0x200E) << std::hex << code;
    for (const auto code : std::initializer_list<std::uint16_t>{0x100C, 0x100D, 0x95C2, 0x9804, 0x9806, 0x9808, 0x9811})
        EXPECT_EQ(ask_with_data(code, Bytes(200'000)).code, 0x200E) << std::hex << code;
    EXPECT_EQ(ask_with_data(0x1016, Bytes(20)).code, 0x2005);
    EXPECT_TRUE(link.all_taken());
    EXPECT_EQ(ask(0x1004).code, 0x2001);
}

} // namespace
} // namespace dicot
