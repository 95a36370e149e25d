// A pixel's neighbours, and how much each resembles it.
#pragma once

#include "cost_rows.h"

#include <algorithm>
#include <array>

namespace dicot::matching {

/// The support weights of a strip of pixels to all neighbours, 0 .. 127.
template <int reach, int stride>
class Neighbourhood
{
public:
    /// Calls pixel(x, neighbours) for each pixel of row y; neighbours(visit) calls visit(weight, dx, dy) for each one
    /// that counts. All are inside the picture.
    template <typename Pixel>
    static void sweep(const Scene& scene, int y, Pixel&& pixel)
    {
        Neighbourhood window;
        for (int x0 = 0; x0 < scene.width; x0 += kStrip) {
            const int count = std::min(kStrip, scene.width - x0);
            window.weigh(scene, y, x0, count);
            for (int i = 0; i < count; ++i)
                pixel(x0 + i, [&](auto&& visit) { window.visit(i, visit); });
        }
    }

private:
    static constexpr int kSide = 2 * reach / stride + 1;
    static constexpr int kStrip = 32;

    void weigh(const Scene& scene, int y, int x0, int count)
    {
        constexpr PairU16 kBoth = {kLeftWeightOne, kLeftWeightOne};
        for (int row = 0; row < kSide; row += 2) {
            const int dy = row * stride - reach;
            const LabRow low = scene.left.lab(y + dy);
            const LabRow high = scene.left.lab(row + 1 < kSide ? y + dy + stride : -1);
            for (int column = 0; column < kSide; ++column) {
                const int dx = column * stride - reach;
                scene.kernels->support_weights(weights_[static_cast<std::size_t>(row / 2 * kSide + column)].data(),
                                               count, moved(scene.left.lab(y), x0), moved(low, x0 + dx),
                                               moved(high, x0 + dx), scene.colour.table, kBoth);
            }
        }
    }

    template <typename Visit>
    void visit(int i, Visit&& visit) const
    {
        for (int row = 0; row < kSide; ++row) {
            for (int column = 0; column < kSide; ++column) {
                const PairU16 pair =
                    weights_[static_cast<std::size_t>(row / 2 * kSide + column)][static_cast<std::size_t>(i)];
                const int weight = (row % 2 == 0 ? pair.low : pair.high) >> 8;
                if (weight > 0)
                    visit(weight, column * stride - reach, row * stride - reach);
            }
        }
    }

    std::array<std::array<PairU16, kStrip>, static_cast<std::size_t>((kSide + 1) / 2 * kSide)> weights_;
};

} // namespace dicot::matching
