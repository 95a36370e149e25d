// What stands in the data, byte by byte, out of the standards' tables.
#include "board.h"

#include "dicot/mtp/datasets.h"
#include "dicot/mtp/snapshot_bytes.h"

#include <string>

namespace dicot {
namespace {

using test::Bytes;
using test::Wire;

template <typename Write>
Bytes written(Write&& write)
{
    Bytes room(4096);
    mtp::SpanSink sink{room};
    mtp::DataWriter out{sink};
    write(out);
    EXPECT_TRUE(out.status().ok());
    return {sink.written().begin(), sink.written().end()};
}

TEST(MtpText, IsACountAndUtf16WithAnEndMark)
{
    const Bytes expected = Wire().u8(5).u16('b').u16(0xE4).u16(0xD83C).u16(0xDF31).u16(0).bytes();
    EXPECT_EQ(written([](mtp::DataWriter& out) { out.text("b\u00E4\U0001F331"); }), expected);
    mtp::DataReader in{expected};
    EXPECT_EQ(in.text<31>().view(), "b\u00E4\U0001F331");
    EXPECT_TRUE(in.ended());
}

TEST(MtpText, EmptyIsOneByte)
{
    EXPECT_EQ(written([](mtp::DataWriter& out) { out.text(""); }), Wire().u8(0).bytes());
}

TEST(MtpText, IsCutToWhatItsCountCanSayAndNotWithinAPair)
{
    const Bytes bytes = written([](mtp::DataWriter& out) { out.text(std::string(253, 'a') + "\U0001F331" + "z"); });
    ASSERT_EQ(bytes.size(), 1u + 2 * 254);
    EXPECT_EQ(bytes[0], std::byte{254});
    EXPECT_EQ(bytes[2 * 252 + 1], std::byte{'a'});
    EXPECT_EQ(bytes[2 * 253 + 1], std::byte{0});
    const Bytes full = written([](mtp::DataWriter& out) { out.text(std::string(1000, 'a')); });
    ASSERT_EQ(full.size(), 1u + 2 * 255);
    EXPECT_EQ(full[0], std::byte{255});
    EXPECT_EQ(full[2 * 254 + 1], std::byte{0});
}

TEST(MtpText, HalvesOfPairsAreReplaced)
{
    const Bytes bytes = Wire().u8(6).u16(0xD83C).u16('a').u16(0xDF31).u16(0xD83C).u16(0xD83C).u16(0).bytes();
    mtp::DataReader in{bytes};
    EXPECT_EQ(in.text<31>().view(), "\uFFFDa\uFFFD\uFFFD\uFFFD");
    EXPECT_TRUE(in.ended());
}

TEST(MtpText, EndsAtItsEndMarkWhateverFollows)
{
    const Bytes bytes = Wire().u8(4).u16('a').u16(0).u16('b').u16(0).u8(7).bytes();
    mtp::DataReader in{bytes};
    EXPECT_EQ(in.text<31>().view(), "a");
    EXPECT_EQ(in.u8(), 7);
    EXPECT_TRUE(in.ended());
}

TEST(MtpText, LongerThanItsRoomIsCutBetweenCharacters)
{
    const Bytes bytes = Wire().u8(4).u16('a').u16(0x20AC).u16('b').u16(0).bytes();
    mtp::DataReader in{bytes};
    EXPECT_EQ(in.text<3>().view(), "a");
    EXPECT_TRUE(in.ended());
}

TEST(MtpReader, BeyondTheEndIsZeroAndTold)
{
    const Bytes bytes = Wire().u16(0x1234).u8(1).bytes();
    mtp::DataReader in{bytes};
    EXPECT_EQ(in.u16(), 0x1234);
    EXPECT_EQ(in.u32(), 0u);
    EXPECT_FALSE(in.ok());
    EXPECT_EQ(in.u8(), 0) << "the byte that is left is not read after a failure";
}

TEST(MtpReader, AnArrayHasNoMoreElementsThanBytes)
{
    for (const std::uint32_t count : {3u, 0x40000001u, 0xFFFFFFFFu}) {
        const Bytes bytes = Wire().u32(count).u32(1).u32(2).bytes();
        mtp::DataReader in{bytes};
        EXPECT_EQ(in.count(4), 0u);
        EXPECT_FALSE(in.ok());
    }
    int visited = 0;
    EXPECT_TRUE(mtp::read_handles(Wire().u32(2).u32(1).u32(2).bytes(), [&](std::uint32_t) { ++visited; }));
    EXPECT_EQ(visited, 2);
}

TEST(MtpDate, IsReadInEveryFormOfTheStandard)
{
    constexpr std::int64_t kNoonUs = 1'772'366'400'000'000;
    EXPECT_EQ(mtp::parse_date("20260301T120000"), kNoonUs);
    EXPECT_EQ(mtp::parse_date("20260301T120000.0Z"), kNoonUs);
    EXPECT_EQ(mtp::parse_date("20260301T133000.5+0130"), kNoonUs);
    EXPECT_EQ(mtp::parse_date("20260301T070000-0500"), kNoonUs);
    for (const char* bad : {"", "20260301", "20260230T120000", "20260301T120000+1", "20260301T120000?0100",
                            "20260301T120000+01x0", "20260301T120000ZZ"})
        EXPECT_FALSE(mtp::parse_date(bad)) << bad;
    EXPECT_EQ(written([](mtp::DataWriter& out) { out.date(kNoonUs + 999'999); }),
              Wire().text("20260301T120000Z").bytes());
}

TEST(MtpDatasets, DeviceInfoIsReadAsPima15740HasIt)
{
    const Bytes bytes = Wire()
                            .u16(100)
                            .u32(6)
                            .u16(100)
                            .text("microsoft.com: 1.0;")
                            .u16(1)
                            .u32(2)
                            .u16(0x1001)
                            .u16(0x95C1)
                            .u32(1)
                            .u16(0x4002)
                            .u32(0)
                            .u32(1)
                            .u16(0x3801)
                            .u32(1)
                            .u16(0x3000)
                            .text("Maker")
                            .text("Model")
                            .text("1.0")
                            .text("S1")
                            .bytes();
    const auto info = mtp::read_device_info(bytes);
    ASSERT_TRUE(info.has_value());
    EXPECT_EQ(info->extension, 6u);
    EXPECT_EQ(info->functional_mode, 1);
    EXPECT_TRUE(info->operations.has(0x95C1));
    EXPECT_FALSE(info->operations.has(0x1002));
    EXPECT_TRUE(info->events.has(0x4002));
    EXPECT_TRUE(info->capture_formats.has(0x3801));
    EXPECT_TRUE(info->formats.has(0x3000));
    EXPECT_EQ(info->model.view(), "Model");
    EXPECT_EQ(info->serial.view(), "S1");
    for (std::size_t cut = 0; cut < bytes.size(); ++cut)
        EXPECT_FALSE(mtp::read_device_info(std::span{bytes}.first(cut))) << cut;
}

TEST(MtpDatasets, MoreCodesThanThereIsRoomForArePassedOver)
{
    Wire wire;
    wire.u16(100).u32(6).u16(100).text("").u16(0).u32(600);
    for (unsigned i = 0; i < 600; ++i)
        wire.u16(0x9000 + i);
    wire.zeros(4 * 4).text("").text("").text("").text("S1");
    const auto info = mtp::read_device_info(wire.bytes());
    ASSERT_TRUE(info.has_value());
    EXPECT_EQ(info->operations.view().size(), 512u);
    EXPECT_EQ(info->serial.view(), "S1");
}

TEST(MtpDatasets, SnapshotNoteIs64Bytes)
{
    mtp::SnapshotNote note{7, 1'772'366'400'000'000, 0x1122334455667788, 0x70, 5, true, {}};
    note.sums.fill(std::byte{0xAB});
    const Bytes expected = Wire()
                               .u64(7)
                               .u64(1'772'366'400'000'000)
                               .u64(0x1122334455667788)
                               .u32(0x70)
                               .u16(5)
                               .u16(1)
                               .add(Bytes(32, std::byte{0xAB}))
                               .bytes();
    ASSERT_EQ(expected.size(), mtp::kSnapshotNoteBytes);
    EXPECT_EQ(written([&](mtp::DataWriter& out) { write(out, note); }), expected);
    mtp::DataReader in{expected};
    EXPECT_EQ(mtp::read_snapshot_note(in), note);
    EXPECT_TRUE(in.ended());
}

TEST(MtpDatasets, PulledNoteIs40BytesAndATimeEight)
{
    mtp::PulledNote note{9, {}};
    note.sums.fill(std::byte{0xCD});
    const Bytes expected = Wire().u64(9).add(Bytes(32, std::byte{0xCD})).bytes();
    ASSERT_EQ(expected.size(), mtp::kPulledNoteBytes);
    EXPECT_EQ(written([&](mtp::DataWriter& out) { write(out, note); }), expected);
    EXPECT_EQ(written([](mtp::DataWriter& out) { write(out, mtp::TimeOffer{-2}); }),
              Wire().u64(0xFFFFFFFFFFFFFFFE).bytes());
}

TEST(MtpContainers, AreTakenOnlyWhole)
{
    const Bytes good = Wire::block(1, 0x1007, 5, {1, 2, 3});
    const auto block = mtp::read_block(mtp::ContainerType::kCommand, good);
    ASSERT_TRUE(block.has_value());
    EXPECT_EQ(block->code, 0x1007);
    EXPECT_EQ(block->transaction, 5u);
    EXPECT_EQ(block->parameter_count, 3u);
    EXPECT_EQ(block->parameters, (std::array<std::uint32_t, 5>{1, 2, 3, 0, 0}));
    EXPECT_FALSE(mtp::read_block(mtp::ContainerType::kResponse, good));
    for (std::size_t cut = 0; cut < good.size(); ++cut)
        EXPECT_FALSE(mtp::read_block(mtp::ContainerType::kCommand, std::span{good}.first(cut))) << cut;
    EXPECT_FALSE(mtp::read_block(mtp::ContainerType::kCommand, Wire::block(1, 0x1007, 5, {1, 2, 3, 4, 5, 6})));
    EXPECT_FALSE(mtp::read_block(mtp::ContainerType::kCommand, Wire::container(1, 0x1007, 5, Bytes(3))));
}

TEST(MtpContainers, DataOfFourGibAndMoreHasNoLength)
{
    EXPECT_EQ(mtp::data_header(0x1009, 1, 0xFFFFFFFF - 13).length, 0xFFFFFFFEu);
    EXPECT_EQ(mtp::data_header(0x1009, 1, 0xFFFFFFFF - 12).length, 0xFFFFFFFFu);
    EXPECT_EQ(mtp::data_header(0x1009, 1, 0x1'0000'0000).length, 0xFFFFFFFFu);
}

} // namespace
} // namespace dicot
