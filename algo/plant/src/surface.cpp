#include "surface.h"

#include "frame.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dicot {
namespace {

/// A surface is torn where depth, as the surface goes on from either side, jumps by more than this many widths of a
/// pixel; or where it is steeper than any blade that a camera sees.
constexpr float kJumpPx = 4, kSteepPx = 12;
constexpr int kBridgePx = 5;
constexpr float kOffsetPx = 2.5F;
constexpr int kRun = 5, kLeastRun = 3;

/// Step in depth from one cell to another, in widths of a pixel.
float step_px(const Surface& surface, float from, float to)
{
    return std::fabs(to - from) * 2 * static_cast<float>(surface.focal_px) / (to + from);
}

void frame_cells(Surface& surface, const PlantView& view, const Canopy& canopy)
{
    int left = view.point.width, right = -1, top = view.point.height, bottom = -1;
    for (int y = 0; y < view.point.height; ++y)
        for (int x = 0; x < view.point.width; ++x) {
            const std::int32_t i = view.point.at(x, y);
            if (i == PlantView::kNoPoint || canopy.plant[static_cast<std::size_t>(i)] == 0)
                continue;
            left = std::min(left, x);
            right = std::max(right, x);
            top = std::min(top, y);
            bottom = std::max(bottom, y);
        }
    if (right < 0)
        return;
    surface.left = left - Surface::kMargin;
    surface.top = top - Surface::kMargin;
    surface.width = right - left + 1 + 2 * Surface::kMargin;
    surface.height = bottom - top + 1 + 2 * Surface::kMargin;
}

void fill_cells(const Surface& surface, const PlantView& view, const Canopy& canopy)
{
    for (std::size_t i = 0; i < surface.cells(); ++i) {
        const std::int32_t index = surface.point(view, i);
        surface.cell[i] = Surface::kNothing;
        surface.inverse[i] = 0;
        if (index == PlantView::kNoPoint)
            continue;
        const auto point = static_cast<std::size_t>(index);
        surface.cell[i] = canopy.plant[point] == 0 ? Surface::kOther : Surface::kPoint;
        surface.plant[i] = canopy.plant[point];
        surface.inverse[i] = static_cast<float>(view.focal_px / point_mm(view, point).z);
    }
}

template <typename Do>
void for_each_inner(const Surface& surface, const Do& act)
{
    for (int y = 1; y + 1 < surface.height; ++y)
        for (int x = 1; x + 1 < surface.width; ++x)
            act(x, y,
                static_cast<std::size_t>(y) * static_cast<std::size_t>(surface.width) + static_cast<std::size_t>(x));
}

/// Medians of 3 x 3 take single wrong depths away and keep jumps.
void smooth(const Surface& surface, std::span<float> smoothed)
{
    std::ranges::copy(surface.inverse, smoothed.begin());
    for_each_inner(surface, [&](int, int, std::size_t i) {
        if (surface.cell[i] != Surface::kPoint)
            return;
        std::array<float, 9> near;
        std::ptrdiff_t count = 0;
        for (int v = -1; v <= 1; ++v)
            for (int u = -1; u <= 1; ++u) {
                const std::size_t j = i + static_cast<std::size_t>(v * surface.width + u);
                if (surface.cell[j] == Surface::kPoint)
                    near[static_cast<std::size_t>(count++)] = surface.inverse[j];
            }
        std::nth_element(near.begin(), near.begin() + count / 2, near.begin() + count);
        smoothed[i] = near[static_cast<std::size_t>(count / 2)];
    });
    std::ranges::copy(smoothed, surface.inverse.begin());
}

/// Cells without a point between two points on opposite sides, not far apart and of about one depth.
void bridge(const Surface& surface, std::span<float> inverse, std::span<std::uint8_t> cell)
{
    constexpr int kWays[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    std::ranges::copy(surface.inverse, inverse.begin());
    std::ranges::copy(surface.cell, cell.begin());
    for_each_inner(surface, [&](int x, int y, std::size_t i) {
        if (surface.cell[i] != Surface::kNothing)
            return;
        // Cells from here to the first that holds a point of the canopy; 0: none near.
        const auto reach = [&](int dx, int dy) {
            for (int k = 1; k <= kBridgePx; ++k) {
                const int u = x + k * dx, v = y + k * dy;
                if (u < 0 || v < 0 || u >= surface.width || v >= surface.height)
                    return 0;
                const std::size_t j = i + static_cast<std::size_t>(k * (dy * surface.width + dx));
                if (surface.cell[j] == Surface::kPoint)
                    return k;
                if (surface.cell[j] == Surface::kOther)
                    return 0;
            }
            return 0;
        };
        int shortest = kBridgePx + 2;
        for (const auto& [dx, dy] : kWays) {
            const int back = reach(-dx, -dy), forth = reach(dx, dy);
            if (back == 0 || forth == 0 || back + forth >= shortest)
                continue;
            const int stride = dy * surface.width + dx;
            const std::size_t from = i - static_cast<std::size_t>(back * stride);
            const std::size_t to = i + static_cast<std::size_t>(forth * stride);
            const float a = surface.inverse[from], b = surface.inverse[to];
            if (surface.plant[from] != surface.plant[to] ||
                step_px(surface, a, b) > kJumpPx / 2 + static_cast<float>(back + forth))
                continue;
            shortest = back + forth;
            inverse[i] = (a * static_cast<float>(forth) + b * static_cast<float>(back)) / static_cast<float>(shortest);
            cell[i] = Surface::kBridge;
            surface.plant[i] = surface.plant[from];
        }
    });
    std::ranges::copy(inverse, surface.inverse.begin());
    std::ranges::copy(cell, surface.cell.begin());
}

/// Whether the surface ends between cell i and the one `stride` further.
bool is_torn(const Surface& surface, std::size_t i, std::size_t stride)
{
    const std::size_t j = i + stride;
    if (!surface.holds(j) || surface.plant[i] != surface.plant[j])
        return true;
    if (surface.cell[i] == Surface::kBridge || surface.cell[j] == Surface::kBridge)
        return false;
    const float a = surface.inverse[i], b = surface.inverse[j];
    const float plain = step_px(surface, a, b);
    if (plain > kSteepPx)
        return true;
    if (plain < kJumpPx)
        return false;
    float least = std::fabs(b - a);
    if (surface.holds(i - 2 * stride))
        least = std::min(least, std::fabs(b - a - (a - surface.inverse[i - 2 * stride]) / 2));
    if (surface.holds(j + 2 * stride))
        least = std::min(least, std::fabs(b - a - (surface.inverse[j + 2 * stride] - b) / 2));
    return least * 2 * static_cast<float>(surface.focal_px) > kJumpPx * (a + b);
}

void tear(const Surface& surface)
{
    const auto below = static_cast<std::size_t>(surface.width);
    std::ranges::fill(surface.torn, std::uint8_t{0});
    const auto mark = [&](std::size_t i, std::uint8_t bit) {
        surface.torn[i] = static_cast<std::uint8_t>(surface.torn[i] | bit);
    };
    for_each_inner(surface, [&](int, int, std::size_t i) {
        if (!surface.holds(i))
            return;
        if (is_torn(surface, i, 1)) {
            mark(i, Surface::kRight);
            mark(i + 1, Surface::kLeft);
        }
        if (is_torn(surface, i, below)) {
            mark(i, Surface::kBelow);
            mark(i + below, Surface::kAbove);
        }
        if (!surface.holds(i - 1))
            mark(i, Surface::kLeft);
        if (!surface.holds(i - below))
            mark(i, Surface::kAbove);
    });
}

/// How far apart two sides are halfway between cell i and the next, in widths of a pixel: straight lines through five
/// cells on either side, the nearest left out, which the matcher mixes from both surfaces. -1: not enough surface.
float offset_px(const Surface& surface, std::size_t i, std::ptrdiff_t stride, std::uint8_t forth, std::uint8_t back)
{
    const auto line = [&](std::size_t from, std::ptrdiff_t step, std::uint8_t side) {
        float sum = 0, moment = 0;
        int count = 0;
        std::size_t at = from;
        for (; count < kRun; ++count) {
            if ((surface.torn[at] & side) != 0)
                break;
            at += static_cast<std::size_t>(step);
            sum += surface.inverse[at];
            moment += static_cast<float>(count) * surface.inverse[at];
        }
        if (count < kLeastRun)
            return -1.0F;
        const auto n = static_cast<float>(count);
        const float middle = (n - 1) / 2, slope = (moment - middle * sum) * 12 / (n * (n * n - 1));
        return sum / n - slope * (middle + 1.5F);
    };
    const float a = line(i, -stride, back), b = line(i + static_cast<std::size_t>(stride), stride, forth);
    return a <= 0 || b <= 0 ? -1 : step_px(surface, a, b);
}

void tear_softly(const Surface& surface, std::span<float> offsets, std::span<std::uint8_t> torn)
{
    const auto below = static_cast<std::ptrdiff_t>(surface.width);
    std::ranges::copy(surface.torn, torn.begin());
    const auto along = [&](std::ptrdiff_t stride, std::uint8_t forth, std::uint8_t back) {
        std::ranges::fill(offsets, -1.0F);
        for_each_inner(surface, [&](int, int, std::size_t i) {
            if (surface.holds(i) && (surface.torn[i] & forth) == 0)
                offsets[i] = offset_px(surface, i, stride, forth, back);
        });
        for_each_inner(surface, [&](int, int, std::size_t i) {
            if (!(offsets[i] > kOffsetPx))
                return;
            std::size_t j = i, k = i;
            for (int way = 0; way < 3; ++way) {
                if ((surface.torn[j] & back) == 0) {
                    j -= static_cast<std::size_t>(stride);
                    if (offsets[j] > offsets[i])
                        return;
                }
                if ((surface.torn[k] & forth) == 0) {
                    k += static_cast<std::size_t>(stride);
                    if (offsets[k] >= offsets[i])
                        return;
                }
            }
            torn[i] = static_cast<std::uint8_t>(torn[i] | forth);
            std::uint8_t& next = torn[i + static_cast<std::size_t>(stride)];
            next = static_cast<std::uint8_t>(next | back);
        });
    };
    along(1, Surface::kRight, Surface::kLeft);
    along(below, Surface::kBelow, Surface::kAbove);
    std::ranges::copy(torn, surface.torn.begin());
}

void measure_inside(const Surface& surface)
{
    constexpr int kAtTear = 3, kStraight = 5, kAcross = 7;
    const auto below = static_cast<std::size_t>(surface.width);
    const std::span<std::int16_t> inside = surface.inside_px5;
    for (std::size_t i = 0; i < surface.cells(); ++i)
        inside[i] = !surface.holds(i) ? std::int16_t{0} : surface.torn[i] ? std::int16_t{kAtTear} : INT16_MAX;
    const auto lower = [&](std::size_t i, std::size_t j, int way) {
        inside[i] = static_cast<std::int16_t>(std::min<int>(inside[i], inside[j] + way));
    };
    const std::size_t first = below + 1, last = surface.cells() - below - 1;
    for (std::size_t i = first; i < last; ++i) {
        if (!surface.holds(i))
            continue;
        lower(i, i - 1, kStraight);
        lower(i, i - below, kStraight);
        lower(i, i - below - 1, kAcross);
        lower(i, i - below + 1, kAcross);
    }
    for (std::size_t i = last; i-- > first;) {
        if (!surface.holds(i))
            continue;
        lower(i, i + 1, kStraight);
        lower(i, i + below, kStraight);
        lower(i, i + below + 1, kAcross);
        lower(i, i + below - 1, kAcross);
    }
}

} // namespace

Surface surface_of(const PlantView& view, const Canopy& canopy, Arena& arena)
{
    Surface surface;
    surface.focal_px = view.focal_px;
    frame_cells(surface, view, canopy);
    surface.cell = arena.take<std::uint8_t>(surface.cells());
    surface.plant = arena.take<std::uint8_t>(surface.cells());
    surface.inverse = arena.take<float>(surface.cells());
    surface.torn = arena.take<std::uint8_t>(surface.cells());
    surface.inside_px5 = arena.take<std::int16_t>(surface.cells());
    const std::size_t mark = arena.used();
    const std::span<float> floats = arena.take<float>(surface.cells());
    const std::span<std::uint8_t> bytes = arena.take<std::uint8_t>(surface.cells());
    if (arena.overrun() || surface.cells() == 0)
        return surface;
    fill_cells(surface, view, canopy);
    smooth(surface, floats);
    bridge(surface, floats, bytes);
    tear(surface);
    tear_softly(surface, floats, bytes);
    arena.rewind(mark);
    measure_inside(surface);
    return surface;
}

} // namespace dicot
