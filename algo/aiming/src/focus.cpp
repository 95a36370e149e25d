#include "dicot/aiming/focus.h"

#include <algorithm>
#include <cstdlib>

namespace dicot::aiming {
namespace {

constexpr int kLeastSide = 32;
/// How far an edge is followed to either side of its steepest place, px.
constexpr int kReach = 12;
/// Edges lower than this could be noise, or the blocks of a JPEG; grey levels times kScale.
constexpr int kScale = 16;
constexpr int kLeastHeight = 24 * kScale;
/// An edge ends where the grey changes less than this part of its steepest change.
constexpr int kTail = 8;
constexpr int kFewestEdges = 60;
/// The figure that four edges in five do not exceed.
constexpr int kQuantile = 80;

/// Counts edges by their steepness in percent.
struct Histogram
{
    std::array<std::int32_t, 101> edges{};
    std::int32_t count = 0;

    void add(int percent)
    {
        ++edges[static_cast<std::size_t>(percent)];
        ++count;
    }
    int figure() const
    {
        if (count < kFewestEdges)
            return Focus::kUnknown;
        std::int32_t sum = 0;
        int percent = 0;
        for (; percent < 100; ++percent) {
            sum += edges[static_cast<std::size_t>(percent)];
            if (std::int64_t{100} * sum >= std::int64_t{kQuantile} * count)
                break;
        }
        return percent;
    }
};

/// A picture along one axis. Edges are looked for along it; across it five pixels are averaged (1 4 6 4 1), which
/// quietens noise and leaves the edge as steep as it is.
struct Axis
{
    ImageView<const std::uint8_t> grey;
    std::ptrdiff_t along, across; ///< steps between pixels

    int at(const std::uint8_t* pixel) const
    {
        return pixel[-2 * across] + 4 * pixel[-across] + 6 * pixel[0] + 4 * pixel[across] + pixel[2 * across];
    }
    int rise(const std::uint8_t* pixel) const { return at(pixel + along) - at(pixel); }
};

} // namespace

Focus focus_of(ImageView<const std::uint8_t> grey) noexcept
{
    (void)grey;
    return {};
}

} // namespace dicot::aiming
