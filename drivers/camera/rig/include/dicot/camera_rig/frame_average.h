// Several pictures of a plant that stands still as one with less noise; what moved is kept from a single picture.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/image.h"
#include "dicot/base/status.h"

#include <cstdint>
#include <span>

namespace dicot {

/// What came of an average.
struct AverageFigures
{
    int pictures = 0;
    std::int64_t moving_pixels = 0;
    int threshold = 0;  ///< luma levels between a pixel's darkest and brightest picture, above which it moved
    bool whole = false; ///< so much moved that the single picture was taken as it is
};

/// Per-pixel mean of up to kMostPictures pictures, integers only. The spread (largest minus smallest luma) of a pixel
/// that stands still is sensor noise; its median over the picture measures that noise. A pixel has moved if its spread,
/// or that of a pixel at most 2 px away, is above kSpread times the median plus kFloor. (Of eight pictures with
/// Gaussian noise the median is 2.85 sigma.) Only luma is looked at: what moves and is as bright as what it covers is
/// averaged.
class FrameAverage
{
public:
    static constexpr int kMostPictures = 64;
    static constexpr int kSpread = 2;
    static constexpr int kMostNoise = 16;         ///< levels; a greater median is movement
    static constexpr int kFloor = 6;              ///< levels
    static constexpr int kMostMovingPercent = 30; ///< more than this is no plant that stands still

    /// Takes its memory from the arena: 9 bytes a pixel. Without pixels where the arena is too small.
    FrameAverage(Arena& arena, int width, int height) noexcept;

    void begin() noexcept;
    /// Pictures beyond kMostPictures are passed over.
    void add(ImageView<const Rgb8> picture) noexcept;
    /// `picture` is one of those that were added, and becomes the average but for what moved.
    AverageFigures finish(ImageView<Rgb8> picture) noexcept;

private:
    int threshold() const noexcept;

    int width_;
    int height_;
    int pictures_ = 0;
    std::span<std::uint16_t> sum_;  ///< three a pixel
    std::span<std::uint8_t> least_; ///< luma
    std::span<std::uint8_t> most_;
    std::span<std::uint8_t> moved_;
};

/// How sharp a picture is, for comparing pictures of one scene: the mean squared step between horizontal neighbours, in
/// 1/256 of a squared luma level.
std::uint64_t sharpness_q8(ImageView<const Rgb8> picture) noexcept;

} // namespace dicot
