// The table as bytes: README.md, "Bytes of a table".
#include "dicot/rectification/remap_table.h"

#include "little_endian.h"

#include "dicot/base/crc32.h"

#include <array>
#include <cstring>

namespace dicot {
namespace {

constexpr std::array<char, 8> kMagic = {'d', 'i', 'c', 'o', 't', 'R', 'T', '1'};
constexpr std::size_t kHeadBytes = 28;
constexpr std::size_t kChecksumBytes = 4;
constexpr std::int32_t kLeastCorner = -8192 * (1 << RemapTable::kCornerFraction);
constexpr std::int32_t kMostCorner = 24576 * (1 << RemapTable::kCornerFraction);
constexpr std::uint32_t kMostErrorSteps =
    static_cast<std::uint32_t>(RemapTable::kMostErrorPx * RemapTable::kErrorSteps);

} // namespace

std::size_t RemapTable::serial_bytes() const
{
    return kHeadBytes + corner_count() * 8 + static_cast<std::size_t>(height_) * 4 + kChecksumBytes;
}

void RemapTable::serialise(std::span<std::byte> into) const
{
    ByteWriter out(into);
    out.word(kMagic);
    for (const int value : {width_, height_, cell_px(), kCornerFraction, worst_error_steps_})
        out.number(static_cast<std::uint32_t>(value), 4);
    for (const Corner& corner : corners_) {
        out.number(static_cast<std::uint32_t>(corner.x), 4);
        out.number(static_cast<std::uint32_t>(corner.y), 4);
    }
    for (const RowRange& range : row_ranges_) {
        out.number(range.first, 2);
        out.number(range.end, 2);
    }
}

std::uint32_t RemapTable::write(std::span<std::byte> into) const
{
    serialise(into);
    const std::size_t body = serial_bytes() - kChecksumBytes;
    const std::uint32_t checksum = crc32(into.first(body));
    ByteWriter(into.subspan(body)).number(checksum, kChecksumBytes);
    return checksum;
}

Result<RemapTable> RemapTable::read(std::span<const std::byte> bytes, Arena& arena, const char* name)
{
    const auto refused = [name](const char* why) { return failure(Fault::kBadData, "%s: %s", name, why); };
    if (bytes.size() < kHeadBytes + kChecksumBytes || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
        return refused("no rectification table");
    ByteReader head(bytes.subspan(kMagic.size()));
    const std::uint32_t width = head.number(4), height = head.number(4), cell = head.number(4),
                        fraction = head.number(4), worst = head.number(4);
    if (width < 8 || height < 8 || width > 16384 || height > 16384 || (cell != 4 && cell != 8) ||
        fraction != kCornerFraction || worst > kMostErrorSteps)
        return refused("a rectification table of a kind that is not known");
    RemapTable table;
    table.width_ = static_cast<int>(width);
    table.height_ = static_cast<int>(height);
    table.cell_log2_ = cell == 8 ? 3 : 2;
    table.worst_error_steps_ = static_cast<int>(worst);
    if (bytes.size() != table.serial_bytes())
        return refused("cut short, or with more behind its end");
    table.take(arena);
    if (arena.overrun())
        return failure(Fault::kSoftware, "%s: the arena is too small for its rectification table", name);
    const std::span<const std::byte> body = bytes.first(bytes.size() - kChecksumBytes);
    if (ByteReader(bytes.subspan(body.size())).number(kChecksumBytes) != crc32(body))
        return refused("damaged (its checksum is wrong)");
    ByteReader in(body.subspan(kHeadBytes));
    for (Corner& corner : table.corners_) {
        corner.x = static_cast<std::int32_t>(in.number(4));
        corner.y = static_cast<std::int32_t>(in.number(4));
        if (corner.x < kLeastCorner || corner.x > kMostCorner || corner.y < kLeastCorner || corner.y > kMostCorner)
            return refused("a position far outside of any picture");
    }
    table.find_row_ranges(table.scratch_);
    for (const RowRange& range : table.row_ranges_) {
        const std::uint32_t first = in.number(2), end = in.number(2);
        if (range.first != first || range.end != end)
            return refused("rows that do not fit its positions");
    }
    return table;
}

} // namespace dicot
