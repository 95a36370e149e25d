// Picture files made by hand, byte by byte, so that expectations owe nothing to the libraries under test.
#pragma once

#include "temp_folder.h"

#include <array>
#include <cstdint>
#include <string>

namespace dicot::test {

inline void append(Bytes& to, const Bytes& more)
{
    to.insert(to.end(), more.begin(), more.end());
}
inline void append32(Bytes& to, std::uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        to.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// PNG, RFC 2083: chunks with their CRC, and pixel data in deflate's stored blocks.
struct PngFile
{
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    std::uint8_t bits = 8;
    std::uint8_t colour_type = 2; ///< 0 grey, 2 RGB, 3 palette, 4 grey + alpha, 6 RGBA
    bool interlaced = false;
    Bytes palette{};
    Bytes transparency{};
    Bytes raster{}; ///< as filtered rows: each begins with its filter, 0

    static std::uint32_t crc(const Bytes& bytes)
    {
        std::uint32_t c = 0xFFFFFFFFU;
        for (const std::uint8_t byte : bytes) {
            c ^= byte;
            for (int k = 0; k < 8; ++k)
                c = (c & 1) != 0 ? 0xEDB88320U ^ (c >> 1) : c >> 1;
        }
        return ~c;
    }
    static void chunk(Bytes& to, const std::string& type, const Bytes& data)
    {
        append32(to, static_cast<std::uint32_t>(data.size()));
        Bytes body(type.begin(), type.end());
        append(body, data);
        append(to, body);
        append32(to, crc(body));
    }
    static Bytes stored(const Bytes& data)
    {
        Bytes out{0x78, 0x01};
        for (std::size_t start = 0; start < data.size() || start == 0; start += 65535) {
            const std::size_t count = std::min<std::size_t>(65535, data.size() - start);
            out.push_back(start + count == data.size() ? 1 : 0);
            const std::uint16_t lengths[] = {static_cast<std::uint16_t>(count), static_cast<std::uint16_t>(~count)};
            for (const std::uint16_t length : lengths) {
                out.push_back(static_cast<std::uint8_t>(length & 0xFF));
                out.push_back(static_cast<std::uint8_t>(length >> 8));
            }
            out.insert(out.end(), data.begin() + static_cast<std::ptrdiff_t>(start),
                       data.begin() + static_cast<std::ptrdiff_t>(start + count));
        }
        std::uint32_t a = 1;
        std::uint32_t b = 0;
        for (const std::uint8_t byte : data) {
            a = (a + byte) % 65521;
            b = (b + a) % 65521;
        }
        append32(out, b << 16 | a);
        return out;
    }
    Bytes bytes() const
    {
        Bytes file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
        Bytes header;
        append32(header, width);
        append32(header, height);
        append(header, {bits, colour_type, 0, 0, static_cast<std::uint8_t>(interlaced ? 1 : 0)});
        chunk(file, "IHDR", header);
        if (!palette.empty())
            chunk(file, "PLTE", palette);
        if (!transparency.empty())
            chunk(file, "tRNS", transparency);
        chunk(file, "IDAT", stored(raster));
        chunk(file, "IEND", {});
        return file;
    }
};

/// A baseline JPEG (ITU T.81) of one 8 x 8 block a component. Component c is flat: 128 + levels[c], where 64 <= |level|
/// <= 127, so that one Huffman code a table is enough: DC category 7 is "0", and the end of the block is "0".
inline Bytes flat_jpeg(const std::vector<int>& levels)
{
    const auto count = static_cast<std::uint8_t>(levels.size());
    Bytes file{0xFF, 0xD8, 0xFF, 0xDB, 0, 67, 0};
    append(file, Bytes(64, 8)); // quantisation: DC in steps of 8 is one grey level
    append(file, {0xFF, 0xC0, 0, static_cast<std::uint8_t>(8 + 3 * count), 8, 0, 8, 0, 8, count});
    for (std::uint8_t c = 1; c <= count; ++c)
        append(file, {c, 0x11, 0});
    for (const std::uint8_t table : {std::uint8_t{0x00}, std::uint8_t{0x10}}) {
        append(file, {0xFF, 0xC4, 0, 20, table, 1});
        append(file, Bytes(15, 0));
        file.push_back(table == 0 ? 7 : 0);
    }
    append(file, {0xFF, 0xDA, 0, static_cast<std::uint8_t>(6 + 2 * count), count});
    for (std::uint8_t c = 1; c <= count; ++c)
        append(file, {c, 0x00});
    append(file, {0, 63, 0});
    std::string bits;
    for (const int level : levels) {
        bits += '0';
        const int code = level > 0 ? level : level + 127;
        for (int bit = 6; bit >= 0; --bit)
            bits += (code >> bit & 1) != 0 ? '1' : '0';
        bits += '0';
    }
    while (bits.size() % 8 != 0)
        bits += '1';
    for (std::size_t i = 0; i < bits.size(); i += 8) {
        file.push_back(static_cast<std::uint8_t>(std::stoi(bits.substr(i, 8), nullptr, 2)));
        if (file.back() == 0xFF)
            file.push_back(0);
    }
    append(file, {0xFF, 0xD9});
    return file;
}

inline Bytes text_bytes(const std::string& text)
{
    return Bytes(text.begin(), text.end());
}

} // namespace dicot::test
