#include "dicot/cloud/disparity_picture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>

namespace dicot {
namespace {

constexpr Rgb8 kMissing{40, 40, 44};
constexpr int kColours = 256;
constexpr double kDarkestBlue = 0.06; // below it turbo is nearly as dark as a missing pixel

/// The polynomial approximation of the turbo map (A. Mikhailov, 2019), t in 0..1.
Rgb8 turbo(double t)
{
    constexpr double kRed[6] = {0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943};
    constexpr double kGreen[6] = {0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604};
    constexpr double kBlue[6] = {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973};
    const auto channel = [t](const double(&c)[6]) {
        const double value = c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
        return static_cast<std::uint8_t>(std::clamp(value, 0.0, 1.0) * 255.0 + 0.5);
    };
    return {channel(kRed), channel(kGreen), channel(kBlue)};
}

struct Span
{
    int least = 0; ///< in whole px above the search range's minimum
    int most = 0;
};

Span middle_98_percent(const ImageView<const DispQ8>& map)
{
    std::array<std::int64_t, 256> pixels{};
    std::int64_t all = 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            if (const DispQ8 d = map.row(y)[x]; d != kDispMissing) {
                ++pixels[d >> kDispFractionBits];
                ++all;
            }
    Span span{0, kMaxDisparities};
    std::int64_t below = 0;
    for (int d = 0; d < 256; ++d) {
        const std::int64_t before = below;
        below += pixels[static_cast<std::size_t>(d)];
        if (before <= all / 100 && below > all / 100)
            span.least = d;
        if (before <= all * 99 / 100 && below > all * 99 / 100)
            span.most = d + 1;
    }
    return span;
}

} // namespace

void paint_disparities(const DisparityMap& map, ImageView<Rgb8> into)
{
    assert(into.width == map.relative.width && into.height == map.relative.height);
    std::array<Rgb8, kColours> colours;
    for (int i = 0; i < kColours; ++i)
        colours[static_cast<std::size_t>(i)] = turbo(kDarkestBlue + (1 - kDarkestBlue) * i / (kColours - 1));
    const Span span = middle_98_percent(map.relative);
    const int least = span.least << kDispFractionBits;
    const int width = std::max(1, (span.most << kDispFractionBits) - least);
    for (int y = 0; y < into.height; ++y) {
        const DispQ8* disparity = map.relative.row(y);
        Rgb8* out = into.row(y);
        for (int x = 0; x < into.width; ++x) {
            const int colour = std::clamp((disparity[x] - least) * (kColours - 1) / width, 0, kColours - 1);
            out[x] = disparity[x] == kDispMissing ? kMissing : colours[static_cast<std::size_t>(colour)];
        }
    }
}

} // namespace dicot
