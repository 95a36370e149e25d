#include "crossing.h"

#include <algorithm>
#include <cmath>

namespace dicot::calibration {

namespace {

constexpr int kMaxSteps = 40;
constexpr double kSettled_px = 1e-3;
constexpr int kPlainSteps = 4;           // before edges that miss the crossing count less
constexpr double kNarrow = 0.35;         // of the window: an edge that passes so far off counts a quarter
constexpr double kClose = 0.12;          // the same where only edges close by may count
constexpr double kSharp_px = 3;          // no edge is sharper than that after smoothing: none is narrower
constexpr double kMinEdgeBalance = 0.01; // smaller against larger eigenvalue of the gradients' spread, squared scale

struct Normal
{
    double xx = 0, xy = 0, yy = 0, x = 0, y = 0;
};

/// Calls visit(offset from the centre, gradient, weight) for the window's pixels.
template <typename Visit>
void for_each_gradient(const GreyLevel& level, Point2 centre, Point2 half_u, Point2 half_v, Visit visit)
{
    const double reach_x = std::abs(half_u.x) + std::abs(half_v.x);
    const double reach_y = std::abs(half_u.y) + std::abs(half_v.y);
    const int x0 = std::max(1, static_cast<int>(std::ceil(centre.x - reach_x)));
    const int x1 = std::min(level.width - 2, static_cast<int>(std::floor(centre.x + reach_x)));
    const int y0 = std::max(1, static_cast<int>(std::ceil(centre.y - reach_y)));
    const int y1 = std::min(level.height - 2, static_cast<int>(std::floor(centre.y + reach_y)));
    const double area = cross(half_u, half_v);

    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            const Point2 off{x - centre.x, y - centre.y};
            const double s = cross(off, half_v) / area;
            const double t = cross(half_u, off) / area;
            if (s * s >= 1 || t * t >= 1)
                continue;
            const Point2 gradient{0.5 * (level.at(x + 1, y) - level.at(x - 1, y)),
                                  0.5 * (level.at(x, y + 1) - level.at(x, y - 1))};
            const double fade = (1 - s * s) * (1 - t * t);
            visit(off, gradient, fade * fade);
        }
    }
}

/// `narrow_px` > 0: edges that pass the centre farther off, a shadow's for example, count less and less.
Normal gather(const GreyLevel& level, Point2 centre, Point2 half_u, Point2 half_v, double narrow_px)
{
    Point2 light{};
    double weights = 0;
    for_each_gradient(level, centre, half_u, half_v, [&](Point2, Point2 gradient, double w) {
        light = light + w * gradient;
        weights += w;
    });
    light = (1 / std::max(weights, 1e-12)) * light;

    Normal sum;
    for_each_gradient(level, centre, half_u, half_v, [&](Point2 off, Point2 gradient, double w) {
        const Point2 g = gradient - light;
        if (narrow_px > 0) {
            const double off_px2 = dot(g, off) * dot(g, off) / std::max(dot(g, g), 1e-12);
            const double ease = 1 / (1 + off_px2 / (narrow_px * narrow_px));
            w *= ease * ease;
        }
        sum.xx += w * g.x * g.x;
        sum.xy += w * g.x * g.y;
        sum.yy += w * g.y * g.y;
        sum.x += w * (g.x * g.x * off.x + g.x * g.y * off.y);
        sum.y += w * (g.x * g.y * off.x + g.y * g.y * off.y);
    });
    return sum;
}

} // namespace

std::optional<Point2> refine_crossing(const GreyLevel& level, Point2 start, Point2 half_u, Point2 half_v,
                                      double max_move_px, Edges edges)
{
    // A window that the picture's border cuts off is no longer centred on the crossing.
    const double reach_x = std::abs(half_u.x) + std::abs(half_v.x);
    const double reach_y = std::abs(half_u.y) + std::abs(half_v.y);
    const double room_x = std::min(start.x, level.width - 1 - start.x) - 1;
    const double room_y = std::min(start.y, level.height - 1 - start.y) - 1;
    const double fit = std::min({1.0, room_x / reach_x, room_y / reach_y});
    half_u = fit * half_u;
    half_v = fit * half_v;
    if (!(fit > 0 && std::abs(cross(half_u, half_v)) >= 1.0))
        return std::nullopt;
    Point2 at = start;
    const bool close = edges == Edges::kCloseBy;
    const int plain_steps = close ? 0 : kPlainSteps;
    const double narrow_px = std::max(kSharp_px, (close ? kClose : kNarrow) * std::min(length(half_u), length(half_v)));
    for (int step = 0; step < kMaxSteps; ++step) {
        const Normal n = gather(level, at, half_u, half_v, step < plain_steps ? 0 : narrow_px);
        const double determinant = n.xx * n.yy - n.xy * n.xy;
        const double trace = n.xx + n.yy;
        if (!(determinant > kMinEdgeBalance * trace * trace))
            return std::nullopt;
        const Point2 move{(n.yy * n.x - n.xy * n.y) / determinant, (n.xx * n.y - n.xy * n.x) / determinant};
        at = at + move;
        if (!(length(at - start) <= max_move_px))
            return std::nullopt;
        if (step >= plain_steps && length(move) < kSettled_px)
            break;
    }
    return at;
}

} // namespace dicot::calibration
