#include "dicot/calibration/board.h"

#include "corner_grid.h"
#include "grey_level.h"
#include "lattice.h"
#include "miss.h"
#include "refine_grid.h"
#include "saddle.h"

#include <algorithm>
#include <cmath>

namespace dicot::calibration {

namespace {

constexpr double kLeastSquare_mm = 0.1;
constexpr double kMostSquare_mm = 1e5;
constexpr double kSearchSigma_px = 1.4;
constexpr double kRefineSigma_px = 1.0;
constexpr std::size_t kMostSaddles = 2500;
constexpr int kFirstLevelSide_px = 1600;
constexpr int kLastLevelSide_px = 160;

struct LevelSearch
{
    std::optional<CornerGrid> grid;
    bool larger_board = false;
    Lattice best;
    int width = 0;
    int height = 0;
};

double area(const CornerGrid& g)
{
    const Point2 p = g.at(g.cols - 1, g.rows - 1) - g.at(0, 0);
    const Point2 q = g.at(0, g.rows - 1) - g.at(g.cols - 1, 0);
    return 0.5 * std::abs(cross(p, q));
}

LevelSearch search_level(ImageView<const std::uint8_t> grey, const Board& board)
{
    const GreyLevel level = smooth(grey, kSearchSigma_px);
    const std::vector<Saddle> saddles = find_saddles(level, kMostSaddles);
    const int max_side = std::max(board.cols, board.rows) + 3;
    std::vector<Lattice> lattices =
        grow_lattices(level, saddles, static_cast<std::size_t>(board.corner_count()), max_side);

    LevelSearch result;
    result.width = grey.width;
    result.height = grey.height;
    bool larger = false;
    for (const Lattice& lattice : lattices) {
        CutOut cut = cut_out(lattice, board);
        larger = larger || cut.larger_board;
        if (cut.grid && (!result.grid || area(*cut.grid) > area(*result.grid)))
            result.grid = std::move(cut.grid);
    }
    result.larger_board = larger && !result.grid;
    if (!lattices.empty())
        result.best = std::move(lattices.front());
    return result;
}

/// Levels in the order in which they are searched: the finest of a handy size, coarser ones, then finer ones.
std::vector<int> level_order(int width, int height)
{
    const int longer = std::max(width, height);
    const int shorter = std::min(width, height);
    int first = 0;
    while ((longer >> first) > kFirstLevelSide_px)
        ++first;
    std::vector<int> order{first};
    for (int coarse = first + 1; (shorter >> coarse) >= kLastLevelSide_px && coarse <= first + 2; ++coarse)
        order.push_back(coarse);
    for (int fine = first - 1; fine >= 0; --fine)
        order.push_back(fine);
    return order;
}

BoardSight as_sight(CornerGrid grid)
{
    BoardSight sight;
    sight.found = true;
    double sum = 0;
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            sum += 0.5 * (length(grid.x_step(col, row)) + length(grid.y_step(col, row)));
    sight.square_px = sum / static_cast<double>(grid.corners.size());
    sight.first_square_bright = grid.first_square_bright;
    sight.corners = std::move(grid.corners);
    return sight;
}

BoardSight unseen(std::string reason)
{
    BoardSight sight;
    sight.reason = std::move(reason);
    return sight;
}

} // namespace

Status check_board(const Board& board)
{
    if (std::min(board.cols, board.rows) < kMinBoardSide || std::max(board.cols, board.rows) > kMaxBoardSide)
        return failure(Fault::kUsage, "a board of %d x %d inner corners cannot be used; give %d to %d a side",
                       board.cols, board.rows, kMinBoardSide, kMaxBoardSide);
    if (!(board.square_mm >= kLeastSquare_mm && board.square_mm <= kMostSquare_mm))
        return failure(Fault::kUsage, "a square of %g mm cannot be used; measure the side of one square",
                       board.square_mm);
    return {};
}

namespace {

/// Looks through the levels of `grey`, a relit copy of `original` or the same; what came nearest when none shows the
/// whole board.
BoardSight search(ImageView<const std::uint8_t> grey, ImageView<const std::uint8_t> original, const Board& board)
{
    LevelSearch nearest;
    bool blurred = false;
    for (const int level : level_order(grey.width, grey.height)) {
        GreyPicture coarse;
        for (int k = 0; k < level; ++k)
            coarse = halve(k == 0 ? grey : coarse.view());
        LevelSearch search = search_level(level == 0 ? grey : coarse.view(), board);
        if (search.grid) {
            const double scale = static_cast<double>(1 << level);
            CornerGrid grid = upright(std::move(*search.grid), board);
            for (Point2& corner : grid.corners)
                corner = {scale * (corner.x + 0.5) - 0.5, scale * (corner.y + 0.5) - 0.5};
            const double sigma_px = kRefineSigma_px * std::sqrt(scale);
            if (refine_grid(smooth(grey, sigma_px), scale, grid) ||
                (grey.data != original.data && refine_grid(smooth(original, sigma_px), scale, grid)))
                return as_sight(std::move(grid));
            blurred = true;
        }
        if (search.best.size() > nearest.best.size())
            nearest = std::move(search);
    }
    if (blurred)
        return unseen("the board is there, but its corners are too blurred to be measured");
    return unseen(explain_miss(nearest.best, nearest.larger_board, board, nearest.width, nearest.height));
}

} // namespace

BoardSight find_board(ImageView<const std::uint8_t> grey, const Board& board)
{
    if (std::string reason = explain_picture(grey); !reason.empty())
        return unseen(std::move(reason));
    BoardSight sight = search(grey, grey, board);
    if (!sight.found)
        if (BoardSight again = search(relit(grey, grey_range(grey)).view(), grey, board); again.found)
            return again;
    return sight;
}

Status agree_on_order(const Board& board, const BoardSight& left, BoardSight& right)
{
    const CornerGrid fixed{board.cols, board.rows, left.corners, left.first_square_bright};
    CornerGrid turned{board.cols, board.rows, right.corners, right.first_square_bright};
    constexpr double kAlike = 0.6; // mean cosine between the board's axes in the two pictures
    CornerGrid best;
    double best_score = -2;
    int allowed = 0;
    for (int turn = 0; turn < 4; ++turn, turned = quarter_turned(turned)) {
        if (turned.cols != board.cols || turned.rows != board.rows ||
            turned.first_square_bright != fixed.first_square_bright)
            continue;
        ++allowed;
        const double score =
            0.5 * (dot(fixed.x_direction(), turned.x_direction()) + dot(fixed.y_direction(), turned.y_direction()));
        if (score > best_score) {
            best_score = score;
            best = turned;
        }
    }
    if (allowed == 0)
        return failure(Fault::kBadData,
                       "the board's colours do not agree between left and right; is it the same board?");
    if (allowed > 1 && best_score < kAlike)
        return failure(Fault::kBadData,
                       "left and right disagree on the board's first corner; hold its rows level in both "
                       "pictures");
    right.corners = std::move(best.corners);
    right.first_square_bright = best.first_square_bright;
    return {};
}

} // namespace dicot::calibration
