// Crossings by where they lie.
#pragma once

#include "saddle.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace dicot::calibration {

/// Saddles by the square of the picture in which they lie, for visits from near to far.
class Neighbourhood
{
public:
    Neighbourhood(const GreyLevel& level, const std::vector<Saddle>& saddles)
        : wide_(level.width / kSide_px + 1), high_(level.height / kSide_px + 1),
          squares_(static_cast<std::size_t>(wide_) * static_cast<std::size_t>(high_))
    {
        for (std::size_t k = 0; k < saddles.size(); ++k)
            square(column(saddles[k].at.x), row(saddles[k].at.y)).push_back(k);
    }

    /// Calls `visit(saddle)` ring by ring; `go_on(distance)` is asked before each ring, no saddle of which is nearer.
    template <typename GoOn, typename Visit>
    void outwards_from(Point2 at, GoOn go_on, Visit visit) const
    {
        const int x = column(at.x);
        const int y = row(at.y);
        const int last = std::max({x, y, wide_ - 1 - x, high_ - 1 - y});
        for (int ring = 0; ring <= last && go_on((ring - 1.0) * kSide_px); ++ring)
            for (int dy = std::max(-ring, -y); dy <= std::min(ring, high_ - 1 - y); ++dy) {
                const int stride = std::abs(dy) == ring ? 1 : std::max(2 * ring, 1);
                for (int dx = -ring; dx <= ring; dx += stride)
                    if (x + dx >= 0 && x + dx < wide_)
                        for (const std::size_t saddle : square(x + dx, y + dy))
                            visit(saddle);
            }
    }

private:
    static constexpr int kSide_px = 24;
    int column(double x) const { return std::clamp(static_cast<int>(x) / kSide_px, 0, wide_ - 1); }
    int row(double y) const { return std::clamp(static_cast<int>(y) / kSide_px, 0, high_ - 1); }
    std::vector<std::size_t>& square(int x, int y) { return squares_[static_cast<std::size_t>(y * wide_ + x)]; }
    const std::vector<std::size_t>& square(int x, int y) const
    {
        return squares_[static_cast<std::size_t>(y * wide_ + x)];
    }

    int wide_;
    int high_;
    std::vector<std::vector<std::size_t>> squares_;
};

} // namespace dicot::calibration
