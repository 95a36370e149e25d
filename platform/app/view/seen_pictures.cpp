#include "seen_pictures.h"

#include "dicot/cloud/disparity_picture.h"
#include "dicot/picture/read_picture.h"
#include "dicot/picture/write_picture.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace dicot::app {
namespace {

constexpr Rgb8 kNothing{40, 40, 44};

class StringSink final : public ByteSink
{
public:
    Status write(std::span<const std::byte> bytes) noexcept override
    {
        text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        return {};
    }
    std::string text;
};

int difference(Rgb8 one, Rgb8 other)
{
    return std::abs(one.r - other.r) + std::abs(one.g - other.g) + std::abs(one.b - other.b);
}

struct Sample
{
    int column, row;
    Rgb8 colour;
};

/// About as many, evenly over the grid's cells that have a point.
std::vector<Sample> samples_of(const PlantView& view, std::size_t wanted)
{
    const std::size_t step = std::max<std::size_t>(1, view.cloud.points.size() / wanted);
    std::vector<Sample> samples;
    std::size_t at = 0;
    for (int y = 0; y < view.point.height; ++y)
        for (int x = 0; x < view.point.width; ++x)
            if (const std::int32_t i = view.point.at(x, y); i != PlantView::kNoPoint && at++ % step == 0)
                samples.push_back({x, y, view.cloud.points[static_cast<std::size_t>(i)].colour});
    return samples;
}

} // namespace

OwnPicture::OwnPicture(int width, int height)
    : pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNothing),
      view(pixels.data(), width, height)
{
}

Result<OwnPicture> OwnPicture::decode(const std::string& file, const char* name)
{
    const auto bytes = std::as_bytes(std::span{file.data(), file.size()});
    const PictureSize size = TRY(picture_size_bytes(bytes, name));
    OwnPicture picture(size.width, size.height);
    TRY(read_picture_bytes(bytes, name, picture.view));
    return picture;
}

GridPlace place_of_its_own(const PlantView& view)
{
    return {view.point.width, view.point.height, 0, 0};
}

GridPlace place_in_picture(const PlantView& view, ImageView<const Rgb8> picture)
{
    const int columns = picture.width - view.point.width + 1;
    const int rows = picture.height - view.point.height + 1;
    if (columns < 1 || rows < 1)
        return place_of_its_own(view);
    constexpr std::int64_t kComparisons = 40'000'000;
    const std::int64_t wanted = std::clamp<std::int64_t>(kComparisons / (std::int64_t{columns} * rows), 32, 1000);
    const std::vector<Sample> samples = samples_of(view, static_cast<std::size_t>(wanted));
    GridPlace best{picture.width, picture.height, 0, 0};
    std::int64_t least = INT64_MAX;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            std::int64_t off = 0;
            for (const Sample& sample : samples) {
                off += difference(sample.colour, picture.at(sample.column + column, sample.row + row));
                if (off >= least)
                    break;
            }
            if (off < least) {
                least = off;
                best.column = column;
                best.row = row;
            }
        }
    return best;
}

OwnPicture picture_of(const PlantView& view)
{
    OwnPicture picture(view.point.width, view.point.height);
    for (int y = 0; y < view.point.height; ++y)
        for (int x = 0; x < view.point.width; ++x)
            if (const std::int32_t i = view.point.at(x, y); i != PlantView::kNoPoint)
                picture.view.at(x, y) = view.cloud.points[static_cast<std::size_t>(i)].colour;
    return picture;
}

OwnPicture disparity_of(const PlantView& view, const GridPlace& place)
{
    constexpr std::int64_t kMost = std::int64_t{kMaxDisparities} << kDispFractionBits;
    std::int32_t nearest = INT32_MAX;
    for (const CloudPoint& point : view.cloud.points)
        nearest = std::min(nearest, point.z);
    std::vector<DispQ8> disparities(static_cast<std::size_t>(place.width) * static_cast<std::size_t>(place.height),
                                    kDispMissing);
    const ImageView<DispQ8> map{disparities.data(), place.width, place.height};
    for (int y = 0; y < view.point.height; ++y)
        for (int x = 0; x < view.point.width; ++x)
            if (const std::int32_t i = view.point.at(x, y); i != PlantView::kNoPoint)
                map.at(x + place.column, y + place.row) =
                    static_cast<DispQ8>(kMost * nearest / view.cloud.points[static_cast<std::size_t>(i)].z);
    OwnPicture painted(place.width, place.height);
    paint_disparities({map, {}, 0, kMaxDisparities}, painted.view);
    return painted;
}

OwnPicture smaller(ImageView<const Rgb8> picture, int width)
{
    const int block = std::max(1, (picture.width + width / 2) / width);
    OwnPicture small(std::max(1, picture.width / block), std::max(1, picture.height / block));
    for (int y = 0; y < small.view.height; ++y)
        for (int x = 0; x < small.view.width; ++x) {
            const int columns = std::min(block, picture.width - x * block);
            const int rows = std::min(block, picture.height - y * block);
            int r = 0, g = 0, b = 0;
            for (int i = 0; i < rows; ++i)
                for (int j = 0; j < columns; ++j) {
                    const Rgb8 pixel = picture.at(x * block + j, y * block + i);
                    r += pixel.r;
                    g += pixel.g;
                    b += pixel.b;
                }
            const int count = columns * rows;
            small.view.at(x, y) = {static_cast<std::uint8_t>(r / count), static_cast<std::uint8_t>(g / count),
                                   static_cast<std::uint8_t>(b / count)};
        }
    return small;
}

std::string jpeg_of(ImageView<const Rgb8> picture)
{
    constexpr int kQuality = 85;
    StringSink sink;
    return write_jpeg(sink, "picture", picture, kQuality).ok() ? std::move(sink.text) : std::string{};
}

std::string png_of(ImageView<const Rgb8> picture)
{
    StringSink sink;
    return write_png(sink, "picture", picture).ok() ? std::move(sink.text) : std::string{};
}

} // namespace dicot::app
