#include "dicot/base/crc32.h"

#include <array>

namespace dicot {
namespace {

using Table = std::array<std::array<std::uint32_t, 256>, 4>;

/// [0]: what one byte does to the remainder; [k]: what it does with k zero bytes behind it.
constexpr Table make_table()
{
    Table table{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t crc = byte;
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1)));
        table[0][byte] = crc;
    }
    for (std::size_t k = 1; k < table.size(); ++k)
        for (std::size_t byte = 0; byte < 256; ++byte)
            table[k][byte] = (table[k - 1][byte] >> 8) ^ table[0][table[k - 1][byte] & 0xFF];
    return table;
}

constexpr Table kTable = make_table();

} // namespace

std::uint32_t crc32(std::span<const std::byte> bytes) noexcept
{
    std::uint32_t crc = 0xFFFFFFFF;
    const auto byte_at = [&](std::size_t i) { return static_cast<std::uint32_t>(bytes[i]); };
    std::size_t i = 0;
    for (; i + 4 <= bytes.size(); i += 4) {
        crc ^= byte_at(i) | byte_at(i + 1) << 8 | byte_at(i + 2) << 16 | byte_at(i + 3) << 24;
        crc =
            kTable[3][crc & 0xFF] ^ kTable[2][(crc >> 8) & 0xFF] ^ kTable[1][(crc >> 16) & 0xFF] ^ kTable[0][crc >> 24];
    }
    for (; i < bytes.size(); ++i)
        crc = (crc >> 8) ^ kTable[0][(crc ^ byte_at(i)) & 0xFF];
    return ~crc;
}

} // namespace dicot
