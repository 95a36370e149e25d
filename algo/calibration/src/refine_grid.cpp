#include "refine_grid.h"

#include "crossing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace dicot::calibration {

namespace {

constexpr double kWindow = 0.75;         // half window over a square's side, where squares lie on both sides
constexpr double kLeastRimWindow = 0.25; // towards the rim of the board, whose squares may be narrow
constexpr double kSmear_px = 3;          // kept clear of the rim, for the edge there is not sharp
constexpr double kMinHalfWindow_px = 2.0;
constexpr double kMaxHalfWindow_px = 28; // on the level where the board was found
constexpr double kMaxMove = 0.3;         // of a square, from the lattice to the refined corner
constexpr double kMaxBend = 0.12;        // of a square, between a corner and the middle of its neighbours
constexpr double kDoubt = 0.05;          // the same, from which on a corner is measured again

/// How far the edge that leaves `at` along `outwards` (one square's step) goes on, as a share of the step: the squares
/// at the rim of a board may be narrow. `across` is the step along the other edge.
double rim_share(const GreyLevel& level, Point2 at, Point2 outwards, Point2 across)
{
    constexpr int kProbes = 20;
    constexpr double kReference = 0.2;
    constexpr double kStillEdge = 0.5; // of the contrast at the reference
    const auto contrast = [&](double share) {
        const Point2 p = at + share * outwards + 0.22 * across;
        const Point2 q = at + share * outwards - 0.22 * across;
        return static_cast<double>(level.sample(p.x, p.y) - level.sample(q.x, q.y));
    };
    const double needed = kStillEdge * contrast(kReference);
    for (int k = 1; k <= kProbes; ++k) {
        const double share = kReference + (1 - kReference) * k / kProbes;
        const Point2 p = at + share * outwards;
        if (!level.contains(p.x, p.y, 1) || (needed > 0 ? contrast(share) < needed : contrast(share) > needed))
            return share - (1 - kReference) / kProbes;
    }
    return 1;
}

Point2 half_window(Point2 step, double share, double scale)
{
    const double side = length(step);
    const double half = std::clamp(share * side, kMinHalfWindow_px, kMaxHalfWindow_px * scale);
    return (half / side) * step;
}

/// The corners with what is known of them.
class Refinement
{
public:
    Refinement(const GreyLevel& level, double scale, const CornerGrid& grid)
        : level_(level), scale_(scale), grid_(grid), exact_(grid.corners.size())
    {
    }

    bool run(CornerGrid& into)
    {
        for (int row = 0; row < grid_.rows; ++row)
            for (int col = 0; col < grid_.cols; ++col)
                at(col, row) = measure(col, row, grid_.at(col, row), Edges::kAll);
        std::vector<std::optional<Point2>> checked = exact_;
        for (int row = 0; row < grid_.rows; ++row)
            for (int col = 0; col < grid_.cols; ++col)
                if (std::optional<Point2>& corner = checked[index(col, row)]; doubtful(col, row))
                    if (const std::optional<Point2> again =
                            measure(col, row, predicted(col, row).value_or(grid_.at(col, row)), Edges::kCloseBy))
                        corner = again;
        if (std::ranges::any_of(checked, [](const auto& corner) { return !corner; }))
            return false;
        std::ranges::transform(checked, into.corners.begin(), [](const auto& corner) { return *corner; });
        return true;
    }

private:
    std::size_t index(int col, int row) const { return static_cast<std::size_t>(row * grid_.cols + col); }
    std::optional<Point2>& at(int col, int row) { return exact_[index(col, row)]; }
    const std::optional<Point2>* inside(int col, int row) const
    {
        const bool there = col >= 0 && row >= 0 && col < grid_.cols && row < grid_.rows;
        return there && exact_[index(col, row)] ? &exact_[index(col, row)] : nullptr;
    }

    std::optional<Point2> measure(int col, int row, Point2 start, Edges edges) const
    {
        const Point2 x_step = grid_.x_step(col, row);
        const Point2 y_step = grid_.y_step(col, row);
        const auto share = [&](int position, int count, Point2 along, Point2 across) {
            if (position > 0 && position + 1 < count)
                return kWindow;
            const Point2 outwards = (position == 0 ? -1.0 : 1.0) * along;
            const double clear = kSmear_px * scale_ / length(along);
            return std::clamp(rim_share(level_, start, outwards, across) - clear, kLeastRimWindow, kWindow);
        };
        const double max_move = std::max(1.5, kMaxMove * std::min(length(x_step), length(y_step)));
        return refine_crossing(level_, start, half_window(x_step, share(col, grid_.cols, x_step, y_step), scale_),
                               half_window(y_step, share(row, grid_.rows, y_step, x_step), scale_), max_move, edges);
    }

    /// Whether the corner was not measured, or lies off the line of its neighbours in its row or column.
    bool doubtful(int col, int row) const
    {
        const std::optional<Point2>* const here = inside(col, row);
        if (here == nullptr)
            return true;
        const auto off_line = [&](int dx, int dy, double step_px) {
            const std::optional<Point2> line = on_line(col, row, dx, dy);
            return line && length(*line - **here) > kDoubt * step_px;
        };
        return off_line(1, 0, length(grid_.x_step(col, row))) || off_line(0, 1, length(grid_.y_step(col, row)));
    }

    /// Where the neighbours in one direction put the corner: in their middle or, at the rim, as far again.
    std::optional<Point2> on_line(int col, int row, int dx, int dy) const
    {
        const auto* const before = inside(col - dx, row - dy);
        const auto* const after = inside(col + dx, row + dy);
        if (before && after)
            return 0.5 * (**before + **after);
        if (const auto* const far = inside(col - 2 * dx, row - 2 * dy); before && far)
            return 2.0 * **before - **far;
        if (const auto* const far = inside(col + 2 * dx, row + 2 * dy); after && far)
            return 2.0 * **after - **far;
        return std::nullopt;
    }

    std::optional<Point2> predicted(int col, int row) const
    {
        const std::optional<Point2> along = on_line(col, row, 1, 0);
        const std::optional<Point2> across = on_line(col, row, 0, 1);
        return along && across ? 0.5 * (*along + *across) : along ? along : across;
    }

    const GreyLevel& level_;
    double scale_;
    const CornerGrid& grid_;
    std::vector<std::optional<Point2>> exact_;
};

/// Rows and columns of a board bend by little: a corner far from its neighbours' middle is none.
bool lies_straight(const CornerGrid& grid)
{
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const Point2 at = grid.at(col, row);
            if (col > 0 && col + 1 < grid.cols) {
                const Point2 bend = 0.5 * (grid.at(col - 1, row) + grid.at(col + 1, row)) - at;
                if (length(bend) > kMaxBend * length(grid.x_step(col, row)))
                    return false;
            }
            if (row > 0 && row + 1 < grid.rows) {
                const Point2 bend = 0.5 * (grid.at(col, row - 1) + grid.at(col, row + 1)) - at;
                if (length(bend) > kMaxBend * length(grid.y_step(col, row)))
                    return false;
            }
        }
    return true;
}

} // namespace

bool refine_grid(const GreyLevel& level, double scale, CornerGrid& grid)
{
    const CornerGrid found = grid;
    if (Refinement(level, scale, found).run(grid) && lies_straight(grid))
        return true;
    grid = found;
    return false;
}

} // namespace dicot::calibration
