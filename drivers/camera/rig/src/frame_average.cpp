#include "dicot/camera_rig/frame_average.h"

#include "dicot/camera/luma.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace dicot {
namespace {

constexpr int kReach = 2; ///< px around a pixel that moved

} // namespace

FrameAverage::FrameAverage(Arena& arena, int width, int height) noexcept : width_(width), height_(height)
{
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    sum_ = arena.take<std::uint16_t>(3 * pixels);
    least_ = arena.take<std::uint8_t>(pixels);
    most_ = arena.take<std::uint8_t>(pixels);
    moved_ = arena.take<std::uint8_t>(pixels);
}

void FrameAverage::begin() noexcept
{
    pictures_ = 0;
    std::ranges::fill(sum_, std::uint16_t{0});
    std::ranges::fill(least_, std::uint8_t{255});
    std::ranges::fill(most_, std::uint8_t{0});
}

void FrameAverage::add(ImageView<const Rgb8> picture) noexcept
{
    if (pictures_ == kMostPictures)
        return;
    ++pictures_;
    std::size_t i = 0;
    for (int y = 0; y < height_; ++y) {
        const Rgb8* row = picture.row(y);
        for (int x = 0; x < width_; ++x, ++i) {
            const Rgb8 pixel = row[x];
            sum_[3 * i] = static_cast<std::uint16_t>(sum_[3 * i] + pixel.r);
            sum_[3 * i + 1] = static_cast<std::uint16_t>(sum_[3 * i + 1] + pixel.g);
            sum_[3 * i + 2] = static_cast<std::uint16_t>(sum_[3 * i + 2] + pixel.b);
            const auto level = luma_of(pixel);
            least_[i] = std::min(least_[i], level);
            most_[i] = std::max(most_[i], level);
        }
    }
}

int FrameAverage::threshold() const noexcept
{
    std::array<std::uint32_t, 256> spreads{};
    for (std::size_t i = 0; i < least_.size(); ++i)
        ++spreads[static_cast<std::size_t>(most_[i] - least_[i])];
    std::size_t below = 0;
    int median = 0;
    while (median < 255 && (below += spreads[static_cast<std::size_t>(median)]) * 2 <= least_.size())
        ++median;
    return kSpread * std::min(median, kMostNoise) + kFloor;
}

AverageFigures FrameAverage::finish(ImageView<Rgb8> picture) noexcept
{
    AverageFigures figures{.pictures = pictures_, .threshold = threshold()};
    if (pictures_ == 0)
        return figures;
    std::ranges::fill(moved_, std::uint8_t{0});
    const auto row_of = [&](int y) { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_); };
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const std::size_t i = row_of(y) + static_cast<std::size_t>(x);
            if (most_[i] - least_[i] <= figures.threshold)
                continue;
            const int from = std::max(x - kReach, 0);
            const int to = std::min(x + kReach, width_ - 1);
            for (int near = std::max(y - kReach, 0); near <= std::min(y + kReach, height_ - 1); ++near)
                std::fill_n(&moved_[row_of(near) + static_cast<std::size_t>(from)], to - from + 1, std::uint8_t{1});
        }
    figures.moving_pixels = std::ranges::count(moved_, std::uint8_t{1});
    figures.whole = figures.moving_pixels * 100 > std::int64_t{kMostMovingPercent} * width_ * height_;
    if (figures.whole)
        return figures;
    const auto mean = [&](std::size_t at) { return static_cast<std::uint8_t>((sum_[at] + pictures_ / 2) / pictures_); };
    for (int y = 0; y < height_; ++y) {
        Rgb8* row = picture.row(y);
        for (int x = 0; x < width_; ++x)
            if (const std::size_t i = row_of(y) + static_cast<std::size_t>(x); moved_[i] == 0)
                row[x] = {mean(3 * i), mean(3 * i + 1), mean(3 * i + 2)};
    }
    return figures;
}

std::uint64_t sharpness_q8(ImageView<const Rgb8> picture) noexcept
{
    std::uint64_t sum = 0;
    for (int y = 0; y < picture.height; ++y) {
        const Rgb8* row = picture.row(y);
        for (int x = 1; x < picture.width; ++x) {
            const int step = luma_of(row[x]) - luma_of(row[x - 1]);
            sum += static_cast<std::uint64_t>(step * step);
        }
    }
    const auto steps = static_cast<std::uint64_t>(std::max(picture.width - 1, 1)) *
                       static_cast<std::uint64_t>(std::max(picture.height, 1));
    return sum * 256 / steps;
}

} // namespace dicot
