// Pictures made by other programs (ImageMagick, cjpeg, jpegtran): the corpus of the fuzz test.
#include "dicot/picture/read_picture.h"

#include "dicot/os/memory_block.h"
#include "dicot/os/process_memory.h"
#include "temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace dicot {
namespace {

using test::Bytes;
using testing::HasSubstr;

std::string corpus(const std::string& name)
{
    return std::string(DICOT_PICTURE_CORPUS) + "/" + name;
}

struct Picture
{
    Status status;
    PictureSize size{};
    std::vector<Rgb8> pixels;
};

Picture read_file(const std::string& path)
{
    const Result<PictureSize> size = picture_size(path.c_str());
    if (!size.ok())
        return {size.status(), {}, {}};
    Picture picture;
    picture.size = size.value();
    picture.pixels.resize(static_cast<std::size_t>(picture.size.pixels()));
    picture.status = read_picture(path.c_str(), {picture.pixels.data(), picture.size.width, picture.size.height});
    return picture;
}

Status read_bytes(std::span<const std::uint8_t> file)
{
    const auto bytes = std::as_bytes(file);
    const Result<PictureSize> size = picture_size_bytes(bytes, "p");
    if (!size.ok())
        return size.status();
    std::vector<Rgb8> pixels(static_cast<std::size_t>(size.value().pixels()));
    return read_picture_bytes(bytes, "p", {pixels.data(), size.value().width, size.value().height});
}

class EveryFile : public testing::TestWithParam<const char*>
{
};

TEST_P(EveryFile, IsReadWholeAndRefusedWhenCutAnywhere)
{
    const Bytes whole = test::bytes_of(corpus(GetParam()));
    ASSERT_TRUE(read_bytes(whole).ok()) << read_bytes(whole).message();
    // Behind the last number of a plain file only a line end is missing.
    const bool plain = whole[0] == 'P' && (whole[1] == '2' || whole[1] == '3');
    std::size_t end = whole.size();
    while (plain && (whole[end - 1] <= ' ' || (end == whole.size() && whole[end - 1] == '\n')))
        --end;
    if (plain) // a shorter last number is a number too
        while (whole[end - 1] > ' ')
            --end;
    for (std::size_t length = 0; length < end; ++length) {
        const Status status = read_bytes(std::span{whole}.first(length));
        ASSERT_EQ(status.fault(), Fault::kBadData) << "cut to " << length << " of " << whole.size() << " bytes";
    }
}

TEST_P(EveryFile, BytesBehindTheEndAreIgnored)
{
    Bytes longer = test::bytes_of(corpus(GetParam()));
    for (int i = 0; i < 40'000; ++i)
        longer.push_back(static_cast<std::uint8_t>(i * 37));
    longer[test::bytes_of(corpus(GetParam())).size()] = ' ';
    EXPECT_TRUE(read_bytes(longer).ok()) << read_bytes(longer).message();
}

TEST_P(EveryFile, ReadsTheSameFromAFileAndFromMemory)
{
    const Picture from_file = read_file(corpus(GetParam()));
    ASSERT_TRUE(from_file.status.ok());
    const Bytes file = test::bytes_of(corpus(GetParam()));
    std::vector<Rgb8> pixels(from_file.pixels.size());
    ASSERT_TRUE(read_picture_bytes(std::as_bytes(std::span{file}), "p",
                                   {pixels.data(), from_file.size.width, from_file.size.height})
                    .ok());
    EXPECT_EQ(pixels, from_file.pixels);
}

INSTANTIATE_TEST_SUITE_P(Corpus, EveryFile,
                         testing::Values("baseline_420.jpg", "baseline_444.jpg", "restart_422.jpg", "grey.jpg",
                                         "progressive_420.jpg", "arithmetic_420.jpg", "rgb8.png", "interlaced.png",
                                         "rgb16.png", "palette.png", "grey8.png", "rgba8.png", "bilevel.png",
                                         "binary.ppm", "plain.ppm", "binary.pgm", "plain.pgm", "binary16.ppm"),
                         [](const testing::TestParamInfo<const char*>& file) {
                             std::string name = file.param;
                             std::replace(name.begin(), name.end(), '.', '_');
                             return name;
                         });

TEST(Corpus, CmykIsRefused)
{
    EXPECT_THAT(read_file(corpus("cmyk.jpg")).status.message(), HasSubstr("CMYK"));
}

TEST(Corpus, LosslessFormsOfOnePictureAgree)
{
    const Picture expected = read_file(corpus("binary.ppm"));
    ASSERT_TRUE(expected.status.ok());
    for (const char* name : {"rgb8.png", "interlaced.png", "rgb16.png", "plain.ppm", "binary16.ppm"})
        EXPECT_EQ(read_file(corpus(name)).pixels, expected.pixels) << name;
}

TEST(Corpus, JpegtransFormsOfOneJpegAgree)
{
    const Picture expected = read_file(corpus("baseline_420.jpg"));
    ASSERT_TRUE(expected.status.ok());
    for (const char* name : {"progressive_420.jpg", "arithmetic_420.jpg"})
        EXPECT_EQ(read_file(corpus(name)).pixels, expected.pixels) << name;
}

TEST(Corpus, AJpegIsTheSameOnEveryCpu)
{
    // FNV-1a of the pixels, as djpeg -dct int writes them.
    const Picture picture = read_file(corpus("baseline_420.jpg"));
    ASSERT_TRUE(picture.status.ok());
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const Rgb8& pixel : picture.pixels)
        for (const std::uint8_t value : {pixel.r, pixel.g, pixel.b})
            hash = (hash ^ value) * 0x100000001b3U;
    EXPECT_EQ(hash, 0x8b8f07c26be0a2b0U);
}

/// A file whose header tells more pixels than its data hold: the sizes that a JPEG's frame header tells.
Bytes with_frame_size(Bytes jpeg, int width, int height)
{
    for (std::size_t i = 0; i + 9 < jpeg.size(); ++i) {
        if (jpeg[i] == 0xFF && (jpeg[i + 1] == 0xC0 || jpeg[i + 1] == 0xC2)) {
            jpeg[i + 5] = static_cast<std::uint8_t>(height >> 8);
            jpeg[i + 6] = static_cast<std::uint8_t>(height & 0xFF);
            jpeg[i + 7] = static_cast<std::uint8_t>(width >> 8);
            jpeg[i + 8] = static_cast<std::uint8_t>(width & 0xFF);
            return jpeg;
        }
    }
    return {};
}

TEST(Bomb, ASmallJpegThatAsksForMuchMemoryIsRefusedBeforeItTakesIt)
{
    const Bytes bomb = with_frame_size(test::bytes_of(corpus("progressive_420.jpg")), 16384, 4096);
    ASSERT_FALSE(bomb.empty());
    const Result<MemoryBlock> block = MemoryBlock::map(std::size_t{16384} * 4096 * 3);
    ASSERT_TRUE(block.ok());
    const std::uint64_t before = process_memory().value().peak_bytes;
    const Status status = read_picture_bytes(std::as_bytes(std::span{bomb}), "bomb.jpg",
                                             {reinterpret_cast<Rgb8*>(block.value().bytes().data()), 16384, 4096});
    EXPECT_EQ(status.fault(), Fault::kBadData);
    EXPECT_THAT(status.message(), HasSubstr("bomb.jpg: decoding this JPEG takes more than 64 MiB"));
    EXPECT_LT(process_memory().value().peak_bytes, before + (std::uint64_t{24} << 20));
}

} // namespace
} // namespace dicot
