// Points where two edges cross, as the corners of a chessboard do.
#pragma once

#include "dicot/calibration/board.h"
#include "grey_level.h"

#include <optional>
#include <vector>

namespace dicot::calibration {

/// A crossing of two edges. `a` and `b` are unit vectors along the edges, each known up to its sign; a x b > 0 (from
/// x towards y), and the sectors between a and b and between -a and -b are the bright ones.
struct Saddle
{
    Point2 at;
    Point2 a;
    Point2 b;
    double contrast = 0; ///< grey levels between the bright and the dark sectors
};

/// Judges the grey values on a ring around `at`: two bright and two dark sectors, opposite ones alike. Nothing when
/// they are not, or when they differ by less than `min_contrast`.
std::optional<Saddle> read_saddle(const GreyLevel& level, Point2 at, double radius_px, double min_contrast);

/// All crossings of a smoothed picture, strongest first, at most `most`.
std::vector<Saddle> find_saddles(const GreyLevel& level, std::size_t most);

inline Point2 operator+(Point2 p, Point2 q)
{
    return {p.x + q.x, p.y + q.y};
}
inline Point2 operator-(Point2 p, Point2 q)
{
    return {p.x - q.x, p.y - q.y};
}
inline Point2 operator*(double s, Point2 p)
{
    return {s * p.x, s * p.y};
}
inline double dot(Point2 p, Point2 q)
{
    return p.x * q.x + p.y * q.y;
}
inline double cross(Point2 p, Point2 q)
{
    return p.x * q.y - p.y * q.x;
}
double length(Point2 p);
Point2 unit(Point2 p);

} // namespace dicot::calibration
