#include "green.h"

#include "frame.h"
#include "groups.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace dicot {
namespace {

/// Excess green (Woebbecke 1995) by the sum of the channels, so that light and shade are alike, above `percent`; and
/// greener than red, which withered leaves, wood and soil are not.
bool is_green(const Rgb8& colour, int percent)
{
    constexpr int kDark = 24; // of 765: noise has any hue
    const int r = colour.r, g = colour.g, b = colour.b, sum = r + g + b;
    return sum > kDark && 100 * (2 * g - r - b) > percent * sum && 100 * (g - r) > 2 * sum;
}

/// Waxy leaves are hardly green; they are taken for leaves where a part of the patch clearly is, or where they are
/// green enough, not blue as pots are, and end in the air: what is printed on a surface goes on beside the green.
constexpr int kHardlyGreen = 10, kGreenEnough = 14, kClearlyGreen = 18;

bool is_waxy(const Rgb8& colour)
{
    const int r = colour.r, g = colour.g, b = colour.b;
    return is_green(colour, kGreenEnough) && 100 * (g - b) > 5 * (r + g + b);
}

/// How high above the ground the canopy begins. On a lawn the ground is green as well.
double least_height_mm(const PlantView& view, const GroundFrame& ground)
{
    if (ground.kind == GroundFrame::Kind::kNone)
        return -HUGE_VAL;
    constexpr std::size_t kStride = 7;
    int near = 0, green = 0;
    for (std::size_t i = 0; i < view.cloud.points.size(); i += kStride) {
        if (std::fabs(in_ground(ground, point_mm(view, i)).z) > 2 * ground.rms_mm)
            continue;
        ++near;
        green += is_green(view.cloud.points[i].colour, kClearlyGreen);
    }
    const bool lawn = green > 0.3 * near;
    return lawn ? 15 + 4 * ground.rms_mm : 3 + 2 * ground.rms_mm;
}

/// Neighbours in the picture hang together where depth steps by less than 10 px are wide.
bool hang_together(const CloudPoint& a, const CloudPoint& b, double focal_px)
{
    constexpr double kSteep = 10;
    return std::fabs(double(a.z) - b.z) * focal_px < kSteep * std::min(a.z, b.z);
}

/// Green points that hang together, by their root.
class Patches
{
public:
    Patches(const PlantView& view, std::span<const std::uint8_t> green, Arena& arena)
        : view_(view), green_(green), groups_(arena.take<std::int32_t>(green.size())),
          size_(arena.take<std::int32_t>(green.size())), confidence_(arena.take<std::int32_t>(green.size())),
          clearly_(arena.take<std::int32_t>(green.size())), waxy_(arena.take<std::int32_t>(green.size())),
          links_(arena.take<std::int32_t>(green.size())), beside_(arena.take<std::int32_t>(green.size()))
    {
    }

    void find()
    {
        for_each_green([&](int x, int y, std::int32_t here) {
            for (const std::int32_t near : {neighbour(x - 1, y), neighbour(x, y - 1)})
                if (near != PlantView::kNoPoint && hang_together(point(near), point(here), view_.focal_px))
                    groups_.join(near, here);
        });
        for (const std::span<std::int32_t> sum : {size_, confidence_, clearly_, waxy_, links_, beside_})
            std::ranges::fill(sum, 0);
        for_each_green([&](int x, int y, std::int32_t here) {
            ++at(size_, here);
            at(confidence_, here) += point(here).confidence;
            at(clearly_, here) += is_green(point(here).colour, kClearlyGreen);
            at(waxy_, here) += is_waxy(point(here).colour);
            for (const auto& [dx, dy] : kWays)
                at(beside_, here) += border(x + dx, y + dy, here);
            largest_ = std::max(largest_, at(size_, here));
            is_confident_ = is_confident_ || point(here).confidence > 0;
        });
    }

    /// Counts, for each patch that is not large, where a large one is near: within 24 px along a row or a column, and
    /// within a fifteenth of the depth.
    void link()
    {
        constexpr int kReachPx = 24, kDepthShare = 15;
        for_each_green([&](int x, int y, std::int32_t here) {
            if (is_large(here))
                return;
            for (const auto& [dx, dy] : kWays)
                for (int k = 1; k <= kReachPx; ++k) {
                    const std::int32_t near = neighbour(x + k * dx, y + k * dy);
                    if (near == PlantView::kNoPoint || !is_large(near))
                        continue;
                    at(links_, here) += kDepthShare * std::abs(point(near).z - point(here).z) < point(here).z;
                    break;
                }
        });
    }

    bool stays(std::int32_t i)
    {
        constexpr int kLeastLinks = 10;
        if (at(size_, i) < kSpeck || !was_seen(i) || !is_leafy(i))
            return false;
        return is_large(i) || at(links_, i) >= kLeastLinks || at(confidence_, i) >= kSure * at(size_, i);
    }

private:
    static constexpr int kSpeck = 60, kGuessed = 60, kSure = 125, kClearShare = 2, kLargeShare = 50;
    static constexpr int kWays[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};

    bool is_leafy(std::int32_t i)
    {
        const std::int32_t least = at(size_, i) / kClearShare;
        return at(clearly_, i) >= least || (at(waxy_, i) >= least && at(beside_, i) < 0);
    }
    /// 1 where the surface goes on there without being green, -1 where it ends, 0 inside the patch.
    int border(int x, int y, std::int32_t here) const
    {
        if (x < 0 || y < 0 || x >= view_.point.width || y >= view_.point.height)
            return 0;
        const std::int32_t near = view_.point.at(x, y);
        if (near == PlantView::kNoPoint || !hang_together(point(near), point(here), view_.focal_px))
            return -1;
        return green_[static_cast<std::size_t>(near)] ? 0 : 1;
    }
    bool was_seen(std::int32_t i) { return !is_confident_ || at(confidence_, i) >= kGuessed * at(size_, i); }
    bool is_large(std::int32_t i) { return was_seen(i) && is_leafy(i) && kLargeShare * at(size_, i) >= largest_; }
    const CloudPoint& point(std::int32_t i) const { return view_.cloud.points[static_cast<std::size_t>(i)]; }
    std::int32_t& at(std::span<std::int32_t> of, std::int32_t i)
    {
        return of[static_cast<std::size_t>(groups_.root(i))];
    }
    /// The green point there, or kNoPoint.
    std::int32_t neighbour(int x, int y) const
    {
        if (x < 0 || y < 0 || x >= view_.point.width || y >= view_.point.height)
            return PlantView::kNoPoint;
        const std::int32_t i = view_.point.at(x, y);
        return i == PlantView::kNoPoint || !green_[static_cast<std::size_t>(i)] ? PlantView::kNoPoint : i;
    }
    template <typename Do>
    void for_each_green(const Do& act)
    {
        for (int y = 0; y < view_.point.height; ++y)
            for (int x = 0; x < view_.point.width; ++x)
                if (const std::int32_t here = neighbour(x, y); here != PlantView::kNoPoint)
                    act(x, y, here);
    }

    const PlantView& view_;
    std::span<const std::uint8_t> green_;
    Groups groups_;
    std::span<std::int32_t> size_, confidence_, clearly_, waxy_, links_;
    std::span<std::int32_t> beside_; ///< border along which the surface goes on, less that at which it ends
    std::int32_t largest_ = 0;
    bool is_confident_ = false; ///< the cloud says at all how sure it is
};

/// Highlights and spots are not green: a point that hangs together with six green ones of its eight neighbours is
/// taken in. Straight borders do not grow by it.
void close_spots(const PlantView& view, std::span<std::uint8_t> green)
{
    constexpr int kRounds = 6, kEnough = 6;
    for (int round = 0; round < kRounds; ++round)
        for (int y = 1; y + 1 < view.point.height; ++y)
            for (int x = 1; x + 1 < view.point.width; ++x) {
                const std::int32_t here = view.point.at(x, y);
                if (here == PlantView::kNoPoint || green[static_cast<std::size_t>(here)])
                    continue;
                int count = 0;
                for (int v = -1; v <= 1; ++v)
                    for (int u = -1; u <= 1; ++u) {
                        const std::int32_t near = view.point.at(x + u, y + v);
                        if (near != PlantView::kNoPoint && green[static_cast<std::size_t>(near)] &&
                            hang_together(view.cloud.points[static_cast<std::size_t>(here)],
                                          view.cloud.points[static_cast<std::size_t>(near)], view.focal_px))
                            ++count;
                    }
                if (count >= kEnough)
                    green[static_cast<std::size_t>(here)] = 1;
            }
}

} // namespace

void find_green(const PlantView& view, const GroundFrame& ground, std::span<std::uint8_t> green, Arena& arena)
{
    const std::size_t mark = arena.used();
    const std::span<std::uint8_t> stays = arena.take<std::uint8_t>(green.size());
    Patches patches(view, green, arena);
    if (arena.overrun())
        return;
    const std::span<const CloudPoint> points = view.cloud.points;
    const double least = least_height_mm(view, ground);
    for (std::size_t i = 0; i < points.size(); ++i)
        green[i] = is_green(points[i].colour, kHardlyGreen) && in_ground(ground, point_mm(view, i)).z > least;
    patches.find();
    patches.link();
    for (std::size_t i = 0; i < points.size(); ++i)
        stays[i] = green[i] && patches.stays(static_cast<std::int32_t>(i));
    std::ranges::copy(stays, green.begin());
    close_spots(view, green);
    arena.rewind(mark);
}

} // namespace dicot
