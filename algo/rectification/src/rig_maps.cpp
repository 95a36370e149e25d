#include "dicot/rectification/rig_maps.h"

#include "little_endian.h"

#include "dicot/base/crc32.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace dicot {
namespace {

// The last letter is to change with the format, and with how tables are built.
constexpr std::array<char, 8> kMagic = {'d', 'i', 'c', 'o', 't', 'R', 'M', '1'};
constexpr std::size_t kNumbers = 2 * (4 + std::tuple_size_v<decltype(Lens::k)>)+std::tuple_size_v<Turn> + 3;
constexpr std::size_t kRigBytes = kMagic.size() + 2 * 4 + kNumbers * 8; // what a rig must have in common with its maps
constexpr std::size_t kHeadBytes = kRigBytes + 8 + 2 * 4;
constexpr std::size_t kChecksumBytes = 4;

void write_rig(ByteWriter& out, const StereoRig& rig)
{
    out.word(kMagic);
    out.number(static_cast<std::uint32_t>(rig.width), 4);
    out.number(static_cast<std::uint32_t>(rig.height), 4);
    for (const Lens* lens : {&rig.left, &rig.right}) {
        for (const double value : {lens->fx, lens->fy, lens->cx, lens->cy})
            out.real(value);
        for (const double value : lens->k)
            out.real(value);
    }
    for (const double value : rig.turn)
        out.real(value);
    for (const double value : {rig.shift_mm.x, rig.shift_mm.y, rig.shift_mm.z})
        out.real(value);
}

/// The CRC-32 of the head and of both tables' own checksums. Not of all bytes: the CRC of something that ends with its
/// own CRC says nothing about it.
std::uint32_t checksum_of(std::span<const std::byte> head, std::uint32_t left, std::uint32_t right)
{
    std::array<std::byte, kHeadBytes + 2 * kChecksumBytes> bytes{};
    std::ranges::copy(head.first(kHeadBytes), bytes.begin());
    ByteWriter sums(std::span{bytes}.subspan(kHeadBytes));
    sums.number(left, kChecksumBytes);
    sums.number(right, kChecksumBytes);
    return crc32(bytes);
}

/// What stands in the last bytes.
std::uint32_t last_number(std::span<const std::byte> bytes)
{
    return ByteReader(bytes.last(kChecksumBytes)).number(kChecksumBytes);
}

} // namespace

std::size_t most_map_bytes(int width, int height)
{
    return kHeadBytes + 2 * RemapTable::most_serial_bytes(width, height) + kChecksumBytes;
}

std::size_t map_bytes(const RigMaps& maps)
{
    return kHeadBytes + maps.left.serial_bytes() + maps.right.serial_bytes() + kChecksumBytes;
}

MapChecksums write_maps(const RigMaps& maps, const StereoRig& rig, double keep, std::span<std::byte> into)
{
    const std::size_t left_bytes = maps.left.serial_bytes(), right_bytes = maps.right.serial_bytes();
    ByteWriter head(into);
    write_rig(head, rig);
    head.real(keep);
    head.number(left_bytes, 4);
    head.number(right_bytes, 4);
    MapChecksums checksums;
    checksums.left = maps.left.write(into.subspan(kHeadBytes, left_bytes));
    checksums.right = maps.right.write(into.subspan(kHeadBytes + left_bytes, right_bytes));
    const std::size_t body = map_bytes(maps) - kChecksumBytes;
    checksums.whole = checksum_of(into, checksums.left, checksums.right);
    ByteWriter(into.subspan(body)).number(checksums.whole, kChecksumBytes);
    return checksums;
}

Result<RigMaps> read_maps(std::span<const std::byte> bytes, const StereoRig& rig, double keep, Arena& arena,
                          const char* name)
{
    const auto refused = [name](const char* why) { return failure(Fault::kBadData, "%s: %s", name, why); };
    if (bytes.size() < kHeadBytes + kChecksumBytes || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
        return refused("no rectification tables of this kind");
    const std::span<const std::byte> body = bytes.first(bytes.size() - kChecksumBytes);
    ByteReader lengths(body.subspan(kHeadBytes - 2 * 4));
    const std::size_t left_bytes = lengths.number(4), right_bytes = lengths.number(4);
    if (left_bytes < kChecksumBytes || right_bytes < kChecksumBytes ||
        left_bytes + right_bytes != body.size() - kHeadBytes)
        return refused("cut short, or with more behind its end");
    const auto left = body.subspan(kHeadBytes, left_bytes), right = body.last(right_bytes);
    if (last_number(bytes) != checksum_of(body, last_number(left), last_number(right)))
        return refused("damaged (its checksum is wrong)");
    std::array<std::byte, kRigBytes> own{};
    ByteWriter out(own);
    write_rig(out, rig);
    if (!std::ranges::equal(body.first(kRigBytes), own))
        return refused("made for another calibration");
    const double made_for = ByteReader(body.subspan(kRigBytes)).real();
    if (made_for != keep)
        return failure(Fault::kConfig, "%s: made for --keep %g", name, made_for);
    const auto table_of = [&](std::span<const std::byte> from) -> Result<RemapTable> {
        RemapTable table = TRY(RemapTable::read(from, arena, name));
        if (table.width() != rig.width || table.height() != rig.height)
            return refused("a table for pictures of another size");
        return table;
    };
    RigMaps maps;
    maps.left = TRY(table_of(left));
    maps.right = TRY(table_of(right));
    return maps;
}

} // namespace dicot
