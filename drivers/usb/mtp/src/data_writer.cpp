#include "dicot/mtp/data_writer.h"

#include "dicot/base/printable.h"
#include "dicot/base/utc_time.h"

#include <algorithm>
#include <array>

namespace dicot::mtp {
namespace {

/// The next character of what printable_into() has made sound.
std::uint32_t take_character(std::string_view& utf8) noexcept
{
    const auto lead = static_cast<unsigned char>(utf8.front());
    const std::size_t size = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    std::uint32_t character = size == 1 ? lead : lead & (0x7Fu >> size);
    for (std::size_t i = 1; i < size && i < utf8.size(); ++i)
        character = (character << 6) | (static_cast<unsigned char>(utf8[i]) & 0x3Fu);
    utf8.remove_prefix(std::min(size, utf8.size()));
    return character;
}

} // namespace

void DataWriter::bytes(std::span<const std::byte> bytes) noexcept
{
    if (status_.ok())
        status_ = sink_.write(bytes);
}

void DataWriter::number(std::uint64_t value, std::size_t size) noexcept
{
    std::array<std::byte, 8> little;
    for (std::size_t i = 0; i < size; ++i)
        little[i] = static_cast<std::byte>(value >> (8 * i));
    bytes(std::span{little}.first(size));
}

void DataWriter::codes(std::span<const std::uint16_t> codes) noexcept
{
    u32(static_cast<std::uint32_t>(codes.size()));
    for (const std::uint16_t code : codes)
        u16(code);
}

void DataWriter::text(std::string_view utf8) noexcept
{
    std::array<char, 4 * kMostTextUnits> sound; // longer than any text that is not cut
    std::string_view rest{sound.data(), printable_into(utf8, sound)};
    std::array<std::uint16_t, kMostTextUnits + 1> units;
    std::size_t used = 0;
    while (!rest.empty()) {
        const std::uint32_t character = take_character(rest);
        if (used + (character < 0x10000 ? 1 : 2) > kMostTextUnits)
            break;
        if (character >= 0x10000)
            units[used++] = static_cast<std::uint16_t>(0xD800 + ((character - 0x10000) >> 10));
        units[used++] = static_cast<std::uint16_t>(character < 0x10000 ? character : 0xDC00 + (character & 0x3FF));
    }
    if (used > 0)
        units[used++] = 0; // the empty string has no end mark
    std::array<std::byte, 1 + 2 * (kMostTextUnits + 1)> packed;
    packed[0] = static_cast<std::byte>(used);
    for (std::size_t i = 0; i < used; ++i) {
        packed[1 + 2 * i] = static_cast<std::byte>(units[i]);
        packed[2 + 2 * i] = static_cast<std::byte>(units[i] >> 8);
    }
    bytes(std::span{packed}.first(1 + 2 * used));
}

void DataWriter::date(std::int64_t us) noexcept
{
    text(utc_stamp(us).view());
}

Status SpanSink::write(std::span<const std::byte> bytes) noexcept
{
    if (bytes.size() > room_.size() - used_)
        return failure(Fault::kSoftware, "data for the cable: %zu bytes do not hold it", room_.size());
    std::copy(bytes.begin(), bytes.end(), room_.begin() + static_cast<std::ptrdiff_t>(used_));
    used_ += bytes.size();
    return {};
}

} // namespace dicot::mtp
