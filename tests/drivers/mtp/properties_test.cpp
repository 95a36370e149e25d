// Properties of objects, as MTP 1.0 adds them to PTP.
#include "board.h"

namespace dicot {
namespace {

using test::Bytes;
using test::MtpBoard;
using test::Wire;

constexpr std::uint64_t kMarkOfB3 = 0x09130507B5AA53C2; ///< FNV-1a of "B3", 64 bits

/// One file's whole property list: ten elements of handle, code, type and value.
void add_all(Wire& wire, std::uint32_t handle, std::uint16_t format, std::uint64_t bytes, std::uint32_t parent,
             std::string_view name)
{
    const auto element = [&](std::uint16_t code, std::uint16_t type) -> Wire& {
        return wire.u32(handle).u16(code).u16(type);
    };
    element(0xDC01, 6).u32(0x00010001);
    element(0xDC02, 4).u16(format);
    element(0xDC03, 4).u16(1);
    element(0xDC04, 8).u64(bytes);
    element(0xDC07, 0xFFFF).text(name);
    element(0xDC08, 0xFFFF).text("20260301T120000Z");
    element(0xDC09, 0xFFFF).text("20260301T120000Z");
    element(0xDC0B, 6).u32(parent);
    element(0xDC41, 10).u64(handle).u64(kMarkOfB3);
    element(0xDC44, 0xFFFF).text(name);
}

TEST_F(MtpBoard, NamesThePropertiesOfItsFormats)
{
    open();
    Wire expected;
    expected.u32(10);
    for (const unsigned code :
         {0xDC01u, 0xDC02u, 0xDC03u, 0xDC04u, 0xDC07u, 0xDC08u, 0xDC09u, 0xDC0Bu, 0xDC41u, 0xDC44u})
        expected.u16(code);
    for (const std::uint32_t format : {0x3000u, 0x3001u, 0x3801u, 0x380Bu})
        EXPECT_EQ(ask(0x9801, {format}).data, expected.bytes());
    EXPECT_EQ(ask(0x9801, {0x3002}).code, 0x200B);
}

TEST_F(MtpBoard, DescribesEachProperty)
{
    open();
    const auto frame = [](std::uint16_t code, std::uint16_t type, const Bytes& fallback) {
        return Wire().u16(code).u16(type).u8(0).add(fallback).u32(0).u8(0).bytes();
    };
    EXPECT_EQ(ask(0x9802, {0xDC01, 0x3000}).data, frame(0xDC01, 6, Bytes(4)));
    EXPECT_EQ(ask(0x9802, {0xDC02, 0x3001}).data, frame(0xDC02, 4, Bytes(2)));
    EXPECT_EQ(ask(0x9802, {0xDC04, 0x3000}).data, frame(0xDC04, 8, Bytes(8)));
    EXPECT_EQ(ask(0x9802, {0xDC41, 0x3801}).data, frame(0xDC41, 10, Bytes(16)));
    EXPECT_EQ(ask(0x9802, {0xDC07, 0x380B}).data, frame(0xDC07, 0xFFFF, Bytes(1)));
    EXPECT_EQ(ask(0x9802, {0xDC05, 0x3000}).code, 0xA801);
    EXPECT_EQ(ask(0x9802, {0xDC07, 0x3002}).code, 0x200B);
}

TEST_F(MtpBoard, TellsOneProperty)
{
    open();
    EXPECT_EQ(ask(0x9803, {kLeft, 0xDC07}).data, Wire().text("left.png").bytes());
    EXPECT_EQ(ask(0x9803, {kSnapshot, 0xDC0B}).data, Wire().u32(kDay).bytes());
    EXPECT_EQ(ask(0x9803, {kLeft, 0xDC41}).data, Wire().u64(kLeft).u64(kMarkOfB3).bytes());
    EXPECT_EQ(ask(0x9803, {kLeft, 0xDC05}).code, 0xA80A);
    EXPECT_EQ(ask(0x9803, {0x99, 0xDC07}).code, 0x2009);
    EXPECT_EQ(ask(0x9810, {kLeft}).data, Wire().u32(0).bytes());
    EXPECT_EQ(ask(0x9810, {0x99}).code, 0x2009);
}

TEST_F(MtpBoard, ListsPropertiesOfOneObject)
{
    open();
    Wire expected;
    expected.u32(10);
    add_all(expected, kLeft, 0x380B, 1000, kSnapshot, "left.png");
    EXPECT_EQ(ask(0x9805, {kLeft, 0, 0xFFFFFFFF, 0, 0}).data, expected.bytes());
    EXPECT_EQ(ask(0x9805, {kLeft, 0, 0xDC04, 0, 0}).data,
              Wire().u32(1).u32(kLeft).u16(0xDC04).u16(8).u64(1000).bytes());
}

TEST_F(MtpBoard, ListsAFolderWithWhatStandsInIt)
{
    open();
    const auto sizes = [](const std::vector<std::pair<std::uint32_t, std::uint64_t>>& objects) {
        Wire wire;
        wire.u32(objects.size());
        for (const auto& [handle, bytes] : objects)
            wire.u32(handle).u16(0xDC04).u16(8).u64(bytes);
        return wire.bytes();
    };
    EXPECT_EQ(ask(0x9805, {kSnapshot, 0, 0xDC04, 0, 1}).data,
              sizes({{kSnapshot, 0}, {kLeft, 1000}, {kCloud, 300'000}, {kSums, 160}}));
    EXPECT_EQ(ask(0x9805, {kSnapshot, 0x380B, 0xDC04, 0, 1}).data, sizes({{kLeft, 1000}}));
    EXPECT_EQ(ask(0x9805, {0, 0, 0xDC04, 0, 1}).data, sizes({{kBoard, 0}})) << "the top";
    EXPECT_EQ(ask(0x9805, {kLeft, 0, 0xDC04, 0, 1}).data, sizes({{kLeft, 1000}})) << "no folder";
    const Bytes all = sizes({{kBoard, 0}, {kSnapshot, 0}, {kDay, 0}, {kLeft, 1000}, {kCloud, 300'000}, {kSums, 160}});
    EXPECT_EQ(ask(0x9805, {0xFFFFFFFF, 0, 0xDC04, 0, 0}).data, all);
    EXPECT_EQ(ask(0x9805, {0xFFFFFFFF, 0, 0xDC04, 0, 0xFFFFFFFF}).data, all);
    EXPECT_EQ(ask(0x9805, {0, 0, 0xDC04, 0, 0xFFFFFFFF}).data, all);
}

TEST_F(MtpBoard, ListsEverythingAsLibmtpAsks)
{
    open();
    Wire expected;
    expected.u32(60);
    add_all(expected, kBoard, 0x3001, 0, 0, "bench-3");
    add_all(expected, kSnapshot, 0x3001, 0, kDay, "000007_120000Z");
    add_all(expected, kDay, 0x3001, 0, kBoard, "2026-03-01");
    add_all(expected, kLeft, 0x380B, 1000, kSnapshot, "left.png");
    add_all(expected, kCloud, 0x3000, 300'000, kSnapshot, "cloud.drc");
    add_all(expected, kSums, 0x3000, 160, kSnapshot, "SHA256SUMS");
    EXPECT_EQ(ask(0x9805, {0xFFFFFFFF, 0, 0xFFFFFFFF, 0, 0xFFFFFFFF}).data, expected.bytes());
}

TEST_F(MtpBoard, ListOfEverythingEndsWhereHostsWouldLosePatience)
{
    open();
    for (std::uint32_t i = 6; i < 40'000; ++i)
        shelf.file(0x1000 + i, kSnapshot, "f.bin", i, kNoonUs);
    const Heard all = ask(0x9805, {0xFFFFFFFF, 0, 0xDC04, 0, 0xFFFFFFFF});
    EXPECT_EQ(all.code, 0x2001);
    EXPECT_EQ(number(all.data, 0, 4), 40'000u);
    EXPECT_EQ(all.data.size(), 4u + 40'000 * 16);
    shelf.file(0x1000, kSnapshot, "f.bin", 1, kNoonUs);
    const Heard none = ask(0x9805, {0xFFFFFFFF, 0, 0xDC04, 0, 0xFFFFFFFF});
    EXPECT_EQ(none.code, 0xA808);
    EXPECT_FALSE(none.had_data);
    EXPECT_EQ(ask(0x9805, {kSnapshot, 0, 0xDC04, 0, 1}).code, 0x2001) << "a folder is listed however much is in it";
}

TEST_F(MtpBoard, SaysWhichListsItDoesNotHave)
{
    open();
    EXPECT_EQ(ask(0x9805, {kLeft, 0, 0, 0, 0}).code, 0x2006);
    EXPECT_EQ(ask(0x9805, {kLeft, 0, 0, 1, 0}).code, 0xA807);
    EXPECT_EQ(ask(0x9805, {kSnapshot, 0, 0xFFFFFFFF, 0, 2}).code, 0xA808);
    EXPECT_EQ(ask(0x9805, {kSnapshot, 0, 0xFFFFFFFF, 0, 0xFFFFFFFF}).code, 0xA808);
    EXPECT_EQ(ask(0x9805, {kLeft, 0, 0xDC05, 0, 0}).code, 0xA80A);
    EXPECT_EQ(ask(0x9805, {kLeft, 0x3002, 0xFFFFFFFF, 0, 0}).code, 0x200B);
    EXPECT_EQ(ask(0x9805, {0x99, 0, 0xFFFFFFFF, 0, 0}).code, 0x2009);
    EXPECT_EQ(ask(0x9805, {kLeft, 0x3801, 0xDC04, 0, 0}).data, Wire().u32(0).bytes());
}

} // namespace
} // namespace dicot
