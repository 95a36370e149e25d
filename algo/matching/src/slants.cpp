#include "slants.h"

#include "point_sums.h"
#include "tables.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace dicot::matching {
namespace {

/// The surroundings that a plane is fitted to, px, and how densely they are asked.
constexpr int kReach = 32;
constexpr int kStride = 4;
constexpr int kRounds = 2;
/// Neighbours farther from the plane than this lie on another surface: 0.7 px, and at first, when there is no plane
/// yet, 0.03 px more for each px of distance.
constexpr int kSameSurface = 179; // 1/256 px
constexpr int kFirstSlope = 8;    // 1/256 px a px
/// Fewer votes make no plane: eight neighbours of the very same colour.
constexpr std::int64_t kQuorum = 8 << 8;
/// Steeper ones are mistakes: half a pixel a pixel.
constexpr std::int64_t kSteepest = 1 << 15;
/// What is added to the variance of the neighbours' positions, 1/256 px^2: a narrow strip makes no slope.
constexpr std::int64_t kStiffness = 128;

/// d(x + dx, y + dy) = centre + across dx + down dy.
struct Slant
{
    std::int64_t centre; ///< 1/256 px
    std::int64_t across; ///< 1/65536 px a px
    std::int64_t down;   ///< 1/65536 px a px

    std::int64_t at(int dx, int dy) const { return centre + (across * dx + down * dy) / 256; }
};

/// Weighted sums of positions and disparities. A weight is at most 2^8, there are at most 17 x 17 of them, |dx| and
/// |dy| are at most 2^5, and |d|, of neighbours near a plane that starts at 0, is below 2^15.
struct SlantSums : PointSums
{
    /// 256 times the covariance of two quantities from the sum of their products and their own sums; products of two
    /// sums stay below 2^60.
    std::int64_t covariance(std::int64_t product, std::int64_t a, std::int64_t b) const
    {
        return (one * product - a * b) / one * 256 / one;
    }

    /// The plane of least squares. Covariances of positions are below 2^19, those with disparities below 2^27.
    Slant plane() const
    {
        const std::int64_t across2 = covariance(xx, x, x) + kStiffness;
        const std::int64_t down2 = covariance(yy, y, y) + kStiffness;
        const std::int64_t both = covariance(xy, x, y);
        const std::int64_t across_d = covariance(x_rise, x, rise);
        const std::int64_t down_d = covariance(y_rise, y, rise);
        const std::int64_t determinant = across2 * down2 - both * both; // positive: kStiffness, and Cauchy-Schwarz
        const auto slope = [&](std::int64_t numerator) {
            return std::clamp(numerator * 256 / determinant, -kSteepest, kSteepest);
        };
        Slant slant{};
        slant.across = slope(across_d * down2 - down_d * both);
        slant.down = slope(down_d * across2 - across_d * both);
        slant.centre = rise / one - (slant.across * x + slant.down * y) / (256 * one);
        return slant;
    }
};

bool certain(Verdict verdict)
{
    return verdict >= Verdict::kVoted;
}

/// What every row's filling reads.
struct Surface
{
    const Maps& maps;
    const Planes& left;
    const ColourWeights& weights;
    int disparities;

    Slant plane_at(int x, int y) const
    {
        const DispQ8 own = maps.disparity.row(y)[x];
        const LabRow centre = left.lab(y);
        Slant slant{};
        for (int round = 0; round < kRounds; ++round) {
            SlantSums sums;
            for (int dy = -kReach; dy <= kReach; dy += kStride) {
                if (y + dy < 0 || y + dy >= maps.disparity.height)
                    continue;
                const Verdict* const verdicts = maps.verdict.row(y + dy);
                const DispQ8* const values = maps.disparity.row(y + dy);
                const LabRow row = left.lab(y + dy);
                for (int dx = -kReach; dx <= kReach; dx += kStride) {
                    const int nx = x + dx;
                    if (nx < 0 || nx >= maps.disparity.width || !certain(verdicts[nx]))
                        continue;
                    const int disparity = values[nx] - own;
                    const int slack = round == 0 ? kFirstSlope * std::max(std::abs(dx), std::abs(dy)) : 0;
                    if (std::abs(disparity - slant.at(dx, dy)) <= kSameSurface + slack)
                        sums.add(weights.between(centre, x, row, nx) >> 7, dx, dy, disparity);
                }
            }
            if (sums.one < kQuorum)
                break;
            slant = sums.plane();
        }
        slant.centre += own;
        return slant;
    }

    /// Fills columns [from, to) of row y, between which and the next nothing is certain.
    void fill(int from, int to, int y) const
    {
        const int width = maps.disparity.width;
        const std::int64_t most = std::int64_t{disparities - 1} << kDispFractionBits;
        const bool left_side = from > 0;
        const bool right_side = to < width;
        const Slant before = left_side ? plane_at(from - 1, y) : Slant{most, 0, 0};
        const Slant after = right_side ? plane_at(to, y) : Slant{most, 0, 0};
        for (int x = from; x < to; ++x) {
            const std::int64_t value = std::min(before.at(x - (from - 1), 0), after.at(x - to, 0));
            maps.disparity.row(y)[x] = static_cast<DispQ8>(std::clamp(value, std::int64_t{0}, most));
        }
    }

    void fill_row(int y) const
    {
        const Verdict* const verdicts = maps.verdict.row(y);
        const int width = maps.disparity.width;
        for (int x = 0; x < width; ++x)
            if (verdicts[x] != Verdict::kMatched)
                maps.confidence.row(y)[x] = 0;
        int to = 0;
        for (int from = 0; from < width; from = to) {
            for (to = from; to < width && !certain(verdicts[to]);)
                ++to;
            if (from == 0 && to == width)
                std::fill_n(maps.disparity.row(y), width, kDispMissing);
            else if (to > from)
                fill(from, to, y);
            while (to < width && certain(verdicts[to]))
                ++to;
        }
    }
};

} // namespace

void fill_along_planes(const Maps& maps, int disparities, const Planes& left, const ColourWeights& weights, Crew& crew)
{
    const Surface surface{maps, left, weights, disparities};
    crew.run(maps.disparity.height, [&](int y) { surface.fill_row(y); });
    fill_empty_rows(maps.disparity);
}

} // namespace dicot::matching
