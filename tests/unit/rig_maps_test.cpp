#include "rendered_maps.h"

#include "dicot/base/crc32.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace dicot {
namespace {

using Bytes = std::vector<std::byte>;

/// Two small cameras with some distortion, their tables and the tables' bytes.
struct SmallRig
{
    StereoRig rig;
    double keep = 0.25;
    test::Memory memory{2 * RemapTable::most_bytes(64, 40)};
    RigMaps maps;
    MapChecksums checksums;
    Bytes bytes;

    SmallRig()
    {
        rig.width = 64;
        rig.height = 40;
        rig.left = {60, 61, 31, 20, {-0.1, 0.02, 0.001, -0.001}};
        rig.right = {62, 61, 32, 19, {-0.12, 0.03, -0.001, 0.002}};
        rig.shift_mm = {-60, 0.5, 0.25};
        const Rectification flat = rectify(rig, keep, "rig.yaml").value();
        Arena arena = memory.arena();
        const auto table_of = [&](const Lens& lens, const Turn& turn) {
            return RemapTable::build(test::map_of(lens, turn, flat), rig.width, rig.height, arena, "rig.yaml").value();
        };
        maps = {table_of(rig.left, flat.left_rectifying), table_of(rig.right, flat.right_rectifying)};
        bytes.resize(map_bytes(maps));
        checksums = write_maps(maps, rig, keep, bytes);
    }
};

struct Read
{
    test::Memory memory{2 * RemapTable::most_bytes(64, 40)};
    Result<RigMaps> maps;

    Read(const Bytes& bytes, const StereoRig& rig, double keep) : maps(read(bytes, rig, keep)) {}
    std::string sentence() const { return maps.status().message(); }

private:
    Result<RigMaps> read(const Bytes& bytes, const StereoRig& rig, double keep)
    {
        Arena arena = memory.arena();
        return read_maps(bytes, rig, keep, arena, "rig.maps");
    }
};

TEST(RigMaps, WhatIsReadIsWhatWasBuilt)
{
    const SmallRig small;
    const Read read(small.bytes, small.rig, small.keep);
    ASSERT_TRUE(read.maps.ok()) << read.sentence();
    Bytes again(map_bytes(read.maps.value()));
    const MapChecksums checksums = write_maps(read.maps.value(), small.rig, small.keep, again);
    EXPECT_EQ(again, small.bytes);
    EXPECT_EQ(checksums.whole, small.checksums.whole);
    EXPECT_EQ(read.maps.value().left.worst_error_px(), small.maps.left.worst_error_px());
    EXPECT_LE(small.bytes.size(), most_map_bytes(small.rig.width, small.rig.height));
    EXPECT_NE(small.checksums.left, small.checksums.right);
}

TEST(RigMaps, TheChecksumOfTheWholeFollowsEachTable)
{
    const SmallRig small;
    Bytes bytes = small.bytes;
    const MapChecksums twice_left = write_maps({small.maps.left, small.maps.left}, small.rig, small.keep, bytes);
    EXPECT_EQ(twice_left.left, small.checksums.left);
    EXPECT_NE(twice_left.whole, small.checksums.whole);
    EXPECT_NE(write_maps(small.maps, small.rig, 0.75, bytes).whole, small.checksums.whole);
    StereoRig other = small.rig;
    other.shift_mm.x = -61;
    EXPECT_NE(write_maps(small.maps, other, small.keep, bytes).whole, small.checksums.whole);
}

TEST(RigMaps, AnyOtherNumberOfTheRigMakesThemForeign)
{
    const SmallRig small;
    std::vector<std::function<void(StereoRig&)>> changes = {
        [](StereoRig& rig) { rig.width += 8; },
        [](StereoRig& rig) { rig.height += 8; },
        [](StereoRig& rig) { std::swap(rig.left, rig.right); },
        [](StereoRig& rig) { rig.shift_mm.x = std::nextafter(rig.shift_mm.x, 0.0); },
        [](StereoRig& rig) { rig.shift_mm.y += 1e-9; },
        [](StereoRig& rig) { rig.shift_mm.z += 1e-9; },
    };
    for (Lens StereoRig::*const side : {&StereoRig::left, &StereoRig::right}) {
        for (double Lens::*const number : {&Lens::fx, &Lens::fy, &Lens::cx, &Lens::cy})
            changes.push_back([=](StereoRig& rig) { rig.*side.*number += 1e-9; });
        for (std::size_t i = 0; i < Lens{}.k.size(); ++i)
            changes.push_back([=](StereoRig& rig) { (rig.*side).k[i] += 1e-9; });
    }
    for (std::size_t i = 0; i < 9; ++i)
        changes.push_back([=](StereoRig& rig) { rig.turn[i] += 1e-9; });
    for (std::size_t i = 0; i < changes.size(); ++i) {
        StereoRig other = small.rig;
        changes[i](other);
        const Read read(small.bytes, other, small.keep);
        ASSERT_FALSE(read.maps.ok()) << "change " << i;
        EXPECT_EQ(read.maps.status().fault(), Fault::kBadData);
        EXPECT_EQ(read.sentence(), "rig.maps: made for another calibration") << "change " << i;
    }
}

TEST(RigMaps, AnotherKeepIsToldFromDamage)
{
    const SmallRig small;
    const Read read(small.bytes, small.rig, 0.5);
    ASSERT_FALSE(read.maps.ok());
    EXPECT_EQ(read.maps.status().fault(), Fault::kConfig);
    EXPECT_EQ(read.sentence(), "rig.maps: made for --keep 0.25");
}

TEST(RigMaps, EveryCutAndEveryDamagedByteIsRefused)
{
    const SmallRig small;
    for (std::size_t count = 0; count < small.bytes.size(); ++count)
        ASSERT_FALSE(Read(Bytes(small.bytes.begin(), small.bytes.begin() + static_cast<std::ptrdiff_t>(count)),
                          small.rig, small.keep)
                         .maps.ok())
            << count;
    Bytes longer = small.bytes;
    longer.push_back({});
    EXPECT_FALSE(Read(longer, small.rig, small.keep).maps.ok());
    for (std::size_t at = 0; at < small.bytes.size(); ++at) {
        Bytes damaged = small.bytes;
        damaged[at] ^= std::byte{0x10};
        ASSERT_FALSE(Read(damaged, small.rig, small.keep).maps.ok()) << at;
    }
}

/// Bytes that lie about lengths, with a checksum that agrees: of the head and of the tables' own checksums (README.md).
Bytes signed_again(Bytes bytes, const SmallRig& small)
{
    const std::size_t right = bytes.size() - 8, left = right - small.maps.right.serial_bytes();
    const std::size_t head = left + 4 - small.maps.left.serial_bytes();
    Bytes covered(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(head));
    for (const std::size_t at : {left, right})
        covered.insert(covered.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                       bytes.begin() + static_cast<std::ptrdiff_t>(at + 4));
    const std::uint32_t crc = crc32(covered);
    for (std::size_t i = 0; i < 4; ++i)
        bytes[bytes.size() - 4 + i] = static_cast<std::byte>(crc >> (8 * i));
    return bytes;
}

TEST(RigMaps, LengthsThatLieAreRefusedAlthoughTheChecksumAgrees)
{
    const SmallRig small;
    const std::size_t lengths =
        small.bytes.size() - small.maps.left.serial_bytes() - small.maps.right.serial_bytes() - 12;
    for (const unsigned lie : {0u, 1u, 0x7Fu, 0xFFu})
        for (std::size_t at = lengths; at < lengths + 8; ++at) {
            Bytes bytes = small.bytes;
            if (bytes[at] == static_cast<std::byte>(lie))
                continue;
            bytes[at] = static_cast<std::byte>(lie);
            EXPECT_FALSE(Read(signed_again(bytes, small), small.rig, small.keep).maps.ok()) << at << ' ' << lie;
        }
    EXPECT_TRUE(Read(signed_again(small.bytes, small), small.rig, small.keep).maps.ok());
}

} // namespace
} // namespace dicot
