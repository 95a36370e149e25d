// The table as bytes: README.md, "Bytes of a table".
#include "dicot/rectification/remap_table.h"

#include <array>
#include <cstring>

namespace dicot {
namespace {

constexpr std::array<char, 8> kMagic = {'d', 'i', 'c', 'o', 't', 'R', 'T', '1'};
constexpr std::size_t kHeadBytes = 24;
constexpr std::size_t kChecksumBytes = 4;
constexpr std::int32_t kLeastCorner = -8192 * (1 << RemapTable::kCornerFraction);
constexpr std::int32_t kMostCorner = 24576 * (1 << RemapTable::kCornerFraction);

std::uint32_t crc32(std::span<const std::byte> bytes)
{
    std::uint32_t crc = 0xFFFFFFFF;
    for (const std::byte byte : bytes) {
        crc ^= static_cast<std::uint32_t>(byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1)));
    }
    return ~crc;
}

class ByteWriter
{
public:
    explicit ByteWriter(std::span<std::byte> into) : into_(into) {}
    void number(std::uint32_t value, std::size_t bytes)
    {
        for (std::size_t i = 0; i < bytes; ++i)
            into_[at_++] = static_cast<std::byte>(value >> (8 * i));
    }

private:
    std::span<std::byte> into_;
    std::size_t at_ = 0;
};

class ByteReader
{
public:
    explicit ByteReader(std::span<const std::byte> from) : from_(from) {}
    std::uint32_t number(std::size_t bytes)
    {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i)
            value |= static_cast<std::uint32_t>(from_[at_++]) << (8 * i);
        return value;
    }

private:
    std::span<const std::byte> from_;
    std::size_t at_ = 0;
};

} // namespace

std::size_t RemapTable::serial_bytes() const
{
    return kHeadBytes + corners_.size() * 8 + row_ranges_.size() * 4 + kChecksumBytes;
}

void RemapTable::serialise(std::span<std::byte> into) const
{
    ByteWriter out(into);
    for (const char letter : kMagic)
        out.number(static_cast<std::uint8_t>(letter), 1);
    for (const int value : {width_, height_, cell_px(), kCornerFraction})
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

void RemapTable::write(std::span<std::byte> into) const
{
    serialise(into);
    const std::size_t body = serial_bytes() - kChecksumBytes;
    ByteWriter(into.subspan(body)).number(crc32(into.first(body)), kChecksumBytes);
}

Result<RemapTable> RemapTable::read(std::span<const std::byte> bytes, Arena& arena, const char* name)
{
    const auto refused = [name](const char* why) {
        return failure(Fault::kBadData, "%s: %s: build the table again from the rig file", name, why);
    };
    if (bytes.size() < kHeadBytes + kChecksumBytes || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
        return refused("no rectification table");
    ByteReader head(bytes.subspan(kMagic.size()));
    const std::uint32_t width = head.number(4), height = head.number(4), cell = head.number(4),
                        fraction = head.number(4);
    if (width < 8 || height < 8 || width > 16384 || height > 16384 || (cell != 4 && cell != 8) ||
        fraction != kCornerFraction)
        return refused("a rectification table of a kind that is not known");
    RemapTable table;
    table.width_ = static_cast<int>(width);
    table.height_ = static_cast<int>(height);
    table.cell_log2_ = cell == 8 ? 3 : 2;
    table.take(arena);
    if (arena.overrun())
        return failure(Fault::kSoftware, "%s: the arena is too small for its rectification table", name);
    if (bytes.size() != table.serial_bytes())
        return refused("cut short, or with more behind its end");
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
