// Pictures as everybody in the house sees them: a borrowed block of pixels.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace dicot {

/// One sRGB pixel, 8 bits a channel, as it lies in memory.
struct Rgb8
{
    std::uint8_t r, g, b;
    friend bool operator==(const Rgb8&, const Rgb8&) = default;
};
static_assert(sizeof(Rgb8) == 3);

/// A borrowed picture. `stride` counts pixels, not bytes; rows run top to bottom; pixel (0, 0) is the centre of the
/// top-left pixel.
template <typename Pixel>
struct ImageView
{
    Pixel* data = nullptr;
    int width = 0;
    int height = 0;
    std::ptrdiff_t stride = 0;

    ImageView() = default;
    ImageView(Pixel* pixels, int w, int h) : data(pixels), width(w), height(h), stride(w) {}
    ImageView(Pixel* pixels, int w, int h, std::ptrdiff_t s) : data(pixels), width(w), height(h), stride(s) {}

    Pixel* row(int y) const
    {
        assert(y >= 0 && y < height);
        return data + y * stride;
    }
    Pixel& at(int x, int y) const
    {
        assert(x >= 0 && x < width);
        return row(y)[x];
    }
    bool empty() const { return width <= 0 || height <= 0; }
    bool same_size(const ImageView<const std::remove_const_t<Pixel>>& other) const
    {
        return width == other.width && height == other.height;
    }

    operator ImageView<const Pixel>() const // NOLINT(google-explicit-constructor)
        requires(!std::is_const_v<Pixel>)
    {
        return {data, width, height, stride};
    }
};

} // namespace dicot
