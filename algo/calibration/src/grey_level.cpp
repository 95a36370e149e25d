#include "grey_level.h"

#include "dicot/base/exact_math.h"

#include <algorithm>
#include <array>

namespace dicot::calibration {

float GreyLevel::sample(double x, double y) const
{
    x = std::clamp(x, 0.0, static_cast<double>(width - 1));
    y = std::clamp(y, 0.0, static_cast<double>(height - 1));
    const int x0 = std::min(static_cast<int>(x), std::max(width - 2, 0));
    const int y0 = std::min(static_cast<int>(y), std::max(height - 2, 0));
    const int x1 = std::min(x0 + 1, width - 1);
    const int y1 = std::min(y0 + 1, height - 1);
    const float fx = static_cast<float>(x - x0);
    const float fy = static_cast<float>(y - y0);
    const float top = at(x0, y0) + fx * (at(x1, y0) - at(x0, y0));
    const float bottom = at(x0, y1) + fx * (at(x1, y1) - at(x0, y1));
    return top + fy * (bottom - top);
}

namespace {

std::vector<float> gaussian(double sigma_px)
{
    const int radius = std::max(1, static_cast<int>(3.0 * sigma_px + 0.5));
    std::vector<double> exact;
    exact.reserve(static_cast<std::size_t>(2 * radius + 1));
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) {
        exact.push_back(exact_exp(-0.5 * i * i / (sigma_px * sigma_px)));
        sum += exact.back();
    }
    std::vector<float> kernel;
    kernel.reserve(exact.size());
    for (const double weight : exact)
        kernel.push_back(static_cast<float>(weight / sum));
    return kernel;
}

} // namespace

GreyLevel smooth(ImageView<const std::uint8_t> grey, double sigma_px)
{
    const std::vector<float> kernel = gaussian(sigma_px);
    const int radius = static_cast<int>(kernel.size() / 2);
    const std::size_t width = static_cast<std::size_t>(grey.width);

    GreyLevel level{grey.width, grey.height, std::vector<float>(width * static_cast<std::size_t>(grey.height))};
    std::vector<float> column(width + 2 * static_cast<std::size_t>(radius));
    for (int y = 0; y < grey.height; ++y) {
        std::fill(column.begin(), column.end(), 0.0F);
        float* const inner = column.data() + radius;
        for (int k = -radius; k <= radius; ++k) {
            const std::uint8_t* const row = grey.row(std::clamp(y + k, 0, grey.height - 1));
            const float weight = kernel[static_cast<std::size_t>(k + radius)];
            for (std::size_t x = 0; x < width; ++x)
                inner[x] += weight * static_cast<float>(row[x]);
        }
        std::fill_n(column.data(), radius, inner[0]);
        std::fill_n(inner + width, radius, inner[width - 1]);
        float* const out = level.pixels.data() + static_cast<std::size_t>(y) * width;
        for (std::size_t k = 0; k < kernel.size(); ++k)
            for (std::size_t x = 0; x < width; ++x)
                out[x] += kernel[k] * column[x + k];
    }
    return level;
}

GreyRange grey_range(ImageView<const std::uint8_t> grey)
{
    std::array<std::int64_t, 256> histogram{};
    for (int y = 0; y < grey.height; ++y)
        for (int x = 0; x < grey.width; ++x)
            ++histogram[grey.at(x, y)];
    const std::int64_t all = std::int64_t{grey.width} * grey.height;
    const auto level_below = [&](std::int64_t percent) {
        std::int64_t sum = 0;
        int value = 0;
        for (; value < 255; ++value) {
            sum += histogram[static_cast<std::size_t>(value)];
            if (100 * sum > percent * all)
                break;
        }
        return value;
    };
    return {level_below(1), level_below(99)};
}

GreyPicture relit(ImageView<const std::uint8_t> grey, GreyRange range)
{
    constexpr int kKnee = 20;
    std::array<std::uint8_t, 256> lit{};
    const int span = std::max(range.bright - range.dark, 1);
    for (int v = 0; v < 256; ++v) {
        const int stretched = std::clamp((255 * (v - range.dark) + span / 2) / span, 0, 255);
        lit[static_cast<std::size_t>(v)] =
            static_cast<std::uint8_t>((stretched * (255 + kKnee) + (stretched + kKnee) / 2) / (stretched + kKnee));
    }
    GreyPicture picture{grey.width, grey.height, {}};
    picture.pixels.reserve(static_cast<std::size_t>(grey.width) * static_cast<std::size_t>(grey.height));
    for (int y = 0; y < grey.height; ++y)
        for (int x = 0; x < grey.width; ++x)
            picture.pixels.push_back(lit[grey.at(x, y)]);
    return picture;
}

GreyPicture halve(ImageView<const std::uint8_t> grey)
{
    GreyPicture half{grey.width / 2, grey.height / 2, {}};
    half.pixels.reserve(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height));
    for (int y = 0; y < half.height; ++y) {
        const std::uint8_t* const top = grey.row(2 * y);
        const std::uint8_t* const bottom = grey.row(2 * y + 1);
        for (int x = 0; x < half.width; ++x) {
            const int sum = top[2 * x] + top[2 * x + 1] + bottom[2 * x] + bottom[2 * x + 1];
            half.pixels.push_back(static_cast<std::uint8_t>((sum + 2) / 4));
        }
    }
    return half;
}

} // namespace dicot::calibration
