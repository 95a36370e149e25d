#include "dicot/aiming/focus.h"

#include <algorithm>

namespace dicot::aiming {
namespace {

constexpr int kLeastSide = 32;
/// How far an edge is followed to either side of its steepest place, px.
constexpr int kReach = 12;
/// Edges lower than this could be noise, or the blocks of a JPEG; grey levels times kScale.
constexpr int kScale = 16;
constexpr int kLeastHeight = 24 * kScale;
/// The least change to a neighbour, in the same units, that is looked at.
constexpr int kLeastSlope = 3 * kScale;
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
    void add(const Histogram& other)
    {
        for (std::size_t i = 0; i < edges.size(); ++i)
            edges[i] += other.edges[i];
        count += other.count;
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
    std::ptrdiff_t along, across; ///< steps between pixels

    int at(const std::uint8_t* pixel) const
    {
        return pixel[-2 * across] + 4 * pixel[-across] + 6 * pixel[0] + 4 * pixel[across] + pixel[2 * across];
    }
    int rise(const std::uint8_t* pixel) const { return at(pixel + along) - at(pixel); }
};

/// Follows an edge from its steepest rise to one side; returns the height gained.
int follow_edge(const Axis& axis, const std::uint8_t* pixel, std::ptrdiff_t step, int sign, int steepest, int reach)
{
    int height = 0;
    for (int i = 0; i < reach; ++i) {
        pixel += step;
        const int rise = sign * axis.rise(pixel);
        if (rise > steepest)
            return -1; // not the steepest place after all
        if (rise * kTail < steepest)
            break;
        height += rise;
    }
    return height;
}

/// Looks at the edge whose steepest rise may be the one after `pixel`, which has `before` and `after` pixels of its
/// axis around it.
void judge(const Axis& axis, const std::uint8_t* pixel, int before, int after, Histogram& edges)
{
    const int rise = axis.rise(pixel), sign = rise < 0 ? -1 : 1, steepest = sign * rise;
    if (steepest < kLeastSlope)
        return;
    // Of a plateau the first place counts.
    if (sign * axis.rise(pixel - axis.along) >= steepest || sign * axis.rise(pixel + axis.along) > steepest)
        return;
    const int down = follow_edge(axis, pixel, -axis.along, sign, steepest, std::min(kReach, before));
    const int up = follow_edge(axis, pixel, axis.along, sign, steepest, std::min(kReach, after));
    if (down < 0 || up < 0 || down + steepest + up < kLeastHeight)
        return;
    edges.add(100 * steepest / (down + steepest + up));
}

} // namespace

Focus focus_of(ImageView<const std::uint8_t> grey) noexcept
{
    Focus focus;
    if (grey.width < kLeastSide || grey.height < kLeastSide)
        return focus;
    const Axis across{1, grey.stride}, down{grey.stride, 1};
    constexpr int kRim = 3;
    Histogram whole;
    std::array<Histogram, kFocusRegions> region;
    for (int y = kRim; y < grey.height - kRim; ++y)
        for (int x = kRim; x < grey.width - kRim; ++x) {
            Histogram& edges = region[static_cast<std::size_t>(3 * y / grey.height * 3 + 3 * x / grey.width)];
            judge(across, grey.row(y) + x, x - 2, grey.width - x - 2, edges);
            judge(down, grey.row(y) + x, y - 2, grey.height - y - 2, edges);
        }
    for (std::size_t i = 0; i < region.size(); ++i) {
        focus.region[i] = region[i].figure();
        whole.add(region[i]);
    }
    focus.whole = whole.figure();
    focus.edges = whole.count;
    return focus;
}

} // namespace dicot::aiming
