#include "miss.h"

#include "grey_level.h"
#include "words.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dicot::calibration {

namespace {

constexpr double kLineCounts = 0.5;   // of a line, from which on it counts as found
constexpr double kBorderReach = 0.75; // of a step beyond the last line, where the next one would be
constexpr double kFewShare = 0.25;    // of the board's corners: texture joins up that many
constexpr double kWholeShare = 0.9;   // of a rectangle's crossings, from which on it is a board
constexpr int kMinContrast = 12;      // grey levels between the 1st and the 99th percentile

int count_in_line(const Lattice& lattice, bool column, int k)
{
    return static_cast<int>(std::count_if(lattice.begin(), lattice.end(), [&](const auto& entry) {
        return (column ? entry.first.i : entry.first.j) == k;
    }));
}

/// Drops outer lines that hold only a few crossings.
Extent trimmed(const Lattice& lattice)
{
    Extent e = extent_of(lattice);
    for (bool again = true; again;) {
        again = false;
        const double tall = kLineCounts * (e.j1 - e.j0 + 1);
        const double wide = kLineCounts * (e.i1 - e.i0 + 1);
        const auto drop = [&](int& end, int inwards, bool column, double needed) {
            if ((column ? e.i1 - e.i0 : e.j1 - e.j0) > 0 && count_in_line(lattice, column, end) < needed) {
                end += inwards;
                again = true;
            }
        };
        drop(e.i0, 1, true, tall);
        drop(e.i1, -1, true, tall);
        drop(e.j0, 1, false, wide);
        drop(e.j1, -1, false, wide);
    }
    return e;
}

struct Side
{
    Point2 outwards; // one step of the lattice, in pixels
    Point2 middle;   // of the outermost line
    bool leaves_picture;
};

Side side_of(const Lattice& lattice, const Extent& e, Cell outwards, int width, int height)
{
    const int line = outwards.i != 0 ? (outwards.i > 0 ? e.i1 : e.i0) : (outwards.j > 0 ? e.j1 : e.j0);
    Side side{{0, 0}, {0, 0}, false};
    int count = 0;
    int outside = 0;
    for (const auto& [cell, node] : lattice) {
        if ((outwards.i != 0 ? cell.i : cell.j) != line)
            continue;
        const auto inner = lattice.find({cell.i - outwards.i, cell.j - outwards.j});
        if (inner == lattice.end())
            continue;
        const Point2 step = node.at - inner->second.at;
        const Point2 next = node.at + kBorderReach * step;
        outside += next.x < 0 || next.y < 0 || next.x > width - 1 || next.y > height - 1 ? 1 : 0;
        side.outwards = side.outwards + step;
        side.middle = side.middle + node.at;
        ++count;
    }
    side.leaves_picture = count > 0 && 3 * outside >= count;
    return side;
}

const char* name_of(Point2 outwards)
{
    if (std::abs(outwards.x) > std::abs(outwards.y))
        return outwards.x < 0 ? "on the left" : "on the right";
    return outwards.y < 0 ? "at the top" : "at the bottom";
}

} // namespace

std::string explain_picture(ImageView<const std::uint8_t> grey)
{
    if (grey.width < 32 || grey.height < 32)
        return text("the picture is too small (%d x %d) to show a board", grey.width, grey.height);
    const auto [dark, bright] = grey_range(grey);
    if (bright - dark >= kMinContrast)
        return {};
    if (bright < 64)
        return "the picture is too dark";
    if (dark > 192)
        return "the picture is overexposed";
    return "the picture has no contrast";
}

std::string explain_miss(const Lattice& best, bool larger_board, const Board& board, int width, int height)
{
    std::string nothing =
        text("no chessboard of %d x %d inner corners found; is it whole in the picture, sharp and evenly lit?",
             board.cols, board.rows);
    if (static_cast<double>(best.size()) < kFewShare * board.corner_count())
        return nothing;
    const Extent e = trimmed(best);
    const int wide = e.i1 - e.i0 + 1;
    const int high = e.j1 - e.j0 + 1;
    if (std::min(wide, high) < kMinBoardSide)
        return nothing;
    // Rows are the lines that lie flatter in the picture; on an oblong board, those that fit its numbers better.
    const Node& first = best.begin()->second;
    bool turned = std::abs(first.u.x) < std::abs(first.v.x);
    if (board.cols != board.rows) {
        const auto misfit = [&](int c, int r) { return std::abs(c - board.cols) + std::abs(r - board.rows); };
        if (misfit(wide, high) != misfit(high, wide))
            turned = misfit(high, wide) < misfit(wide, high);
    }
    const int cols = turned ? high : wide;
    const int rows = turned ? wide : high;
    const bool another = (cols > board.cols || rows > board.rows) &&
                         static_cast<double>(best.size()) >= kWholeShare * cols * rows; // texture leaves gaps
    if (larger_board || another || (cols >= board.cols && rows >= board.rows && cols * rows > board.corner_count()))
        return text("the board has at least %d x %d inner corners, not %d x %d; check --corners",
                    std::max(cols, larger_board ? board.cols : cols), rows, board.cols, board.rows);

    if (cols > board.cols || rows > board.rows)
        return nothing;
    const bool rows_missing = rows < board.rows;
    const bool cols_missing = cols < board.cols;
    if (!rows_missing && !cols_missing && static_cast<int>(best.size()) >= board.corner_count())
        return "the board is there, but shadows, glare or dirt look like corners of it, or --corners is wrong";
    if (!rows_missing && !cols_missing)
        return text("%zu of %d corners found; the others are hidden, in glare or too dark, or --corners is wrong",
                    best.size(), board.corner_count());

    std::string reason;
    if (rows_missing)
        reason += text("%d of %d rows", rows, board.rows);
    if (cols_missing)
        reason += text("%s%d of %d columns", rows_missing ? " and " : "", cols, board.cols);
    reason += " found; ";

    std::string cut;
    for (const Cell outwards : {Cell{-1, 0}, Cell{1, 0}, Cell{0, -1}, Cell{0, 1}}) {
        const bool across_columns = (outwards.i != 0) != turned;
        if (across_columns ? !cols_missing : !rows_missing)
            continue;
        const Side side = side_of(best, e, outwards, width, height);
        if (side.leaves_picture)
            cut += (cut.empty() ? "" : " and ") + std::string(name_of(side.outwards));
    }
    if (!cut.empty())
        return reason + "board cut off " + cut;
    return reason + "the others are hidden, in glare or too dark, or the board is a smaller one: check --corners";
}

} // namespace dicot::calibration
