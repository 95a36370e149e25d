// Makes the frames of a virtual camera out of a picture.
//
//   make_frames PICTURE FOLDER WIDTHxHEIGHT COUNT [FIRST_COLUMN [STEP]]
//
// Frame k is what a window at column FIRST_COLUMN + k * STEP of the picture shows, the picture repeated in all
// directions; nothing is scaled. FOLDER gets <size>_<k>.yuyv and <size>_<k>.jpg of each.
#include "dicot/picture/read_picture.h"
#include "dicot/picture/write_picture.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace {

using namespace dicot;

// BT.601, 16 .. 235 and 16 .. 240, in 1/256 and rounded: what webcams send as YUY2.
int luma(const Rgb8& p)
{
    return ((66 * p.r + 129 * p.g + 25 * p.b + 128) >> 8) + 16;
}
int blue_difference(const Rgb8& a, const Rgb8& b)
{
    return ((-38 * (a.r + b.r) - 74 * (a.g + b.g) + 112 * (a.b + b.b) + 256) >> 9) + 128;
}
int red_difference(const Rgb8& a, const Rgb8& b)
{
    return ((112 * (a.r + b.r) - 94 * (a.g + b.g) - 18 * (a.b + b.b) + 256) >> 9) + 128;
}

std::vector<char> yuyv_of(ImageView<const Rgb8> picture)
{
    std::vector<char> bytes;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; x += 2) {
            const Rgb8& a = picture.at(x, y);
            const Rgb8& b = picture.at(x + 1, y);
            for (const int value : {luma(a), blue_difference(a, b), luma(b), red_difference(a, b)})
                bytes.push_back(static_cast<char>(static_cast<unsigned char>(value)));
        }
    return bytes;
}

struct Wish
{
    int width = 0, height = 0, count = 0, first = 0, step = 8;
};

Result<Wish> wish_of(std::span<char* const> words)
{
    Wish wish;
    std::array<int, 3> numbers = {0, 0, 8};
    for (std::size_t i = 3; i < words.size() && i < 6; ++i) {
        const std::string word = words[i];
        if (std::from_chars(word.data(), word.data() + word.size(), numbers[i - 3]).ec != std::errc{} ||
            numbers[i - 3] < 0)
            return failure(Fault::kUsage, "'%s' should be a number from 0", words[i]);
    }
    if (words.size() < 4 || std::sscanf(words[2], "%5dx%5d", &wish.width, &wish.height) != 2 || wish.width < 2 ||
        wish.height < 1 || wish.width % 2 != 0 || numbers[0] < 1)
        return failure(Fault::kUsage,
                       "say PICTURE FOLDER WIDTHxHEIGHT COUNT [FIRST_COLUMN [STEP]], with an even width");
    wish.count = numbers[0];
    wish.first = numbers[1];
    wish.step = numbers[2];
    return wish;
}

Status write_frame(const std::string& stem, ImageView<const Rgb8> picture)
{
    const std::vector<char> bytes = yuyv_of(picture);
    std::ofstream file(stem + ".yuyv", std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!file.flush())
        return failure(Fault::kCannotCreate, "%s.yuyv: cannot be written", stem.c_str());
    return write_jpeg((stem + ".jpg").c_str(), picture, 90);
}

Status run(std::span<char* const> words)
{
    const Wish wish = TRY(wish_of(words));
    const PictureSize size = TRY(picture_size(words[0]));
    std::vector<Rgb8> pixels(static_cast<std::size_t>(size.pixels()));
    const ImageView<Rgb8> picture(pixels.data(), size.width, size.height);
    TRY(read_picture(words[0], picture));
    std::vector<Rgb8> window(static_cast<std::size_t>(wish.width) * static_cast<std::size_t>(wish.height));
    const ImageView<Rgb8> frame(window.data(), wish.width, wish.height);
    for (int k = 0; k < wish.count; ++k) {
        for (int y = 0; y < wish.height; ++y)
            for (int x = 0; x < wish.width; ++x)
                frame.at(x, y) = picture.at((wish.first + k * wish.step + x) % size.width, y % size.height);
        TRY(write_frame(std::string(words[1]) + "/" + words[2] + "_" + std::to_string(k), frame));
    }
    return {};
}

} // namespace

int main(int argc, char** argv)
{
    const dicot::Status status = run({argv + 1, static_cast<std::size_t>(argc > 0 ? argc - 1 : 0)});
    if (!status.ok())
        std::fprintf(stderr, "make_frames: %s\n", status.message());
    return status.exit_code();
}
