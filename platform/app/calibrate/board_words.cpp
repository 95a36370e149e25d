#include "board_words.h"

#include <algorithm>
#include <charconv>

namespace dicot::app {
namespace {

using calibration::Board;

/// Boards that are being named, until a folder follows.
struct Group
{
    std::vector<std::string> folders;
    std::vector<Board> boards;
    std::vector<double> squares_mm;

    bool has_board() const { return !boards.empty() || !squares_mm.empty(); }
};

Result<Board> sides_of(const BoardWord& word)
{
    const char* option = word.kind == BoardWord::kCorners ? "--corners" : "--squares";
    const char* end = word.value.data() + word.value.size();
    Board board;
    const auto columns = std::from_chars(word.value.data(), end, board.cols);
    const bool sign = columns.ec == std::errc{} && columns.ptr != end && (*columns.ptr == 'x' || *columns.ptr == 'X');
    const auto rows = sign ? std::from_chars(columns.ptr + 1, end, board.rows) : columns;
    if (!sign || rows.ec != std::errc{} || rows.ptr != end)
        return failure(Fault::kUsage, "%s %.40s: give columns x rows as two whole numbers, like %s", option,
                       word.value.c_str(), word.kind == BoardWord::kCorners ? "9x6" : "10x7");
    if (word.kind == BoardWord::kSquares) {
        board.cols = std::max(board.cols, 1) - 1;
        board.rows = std::max(board.rows, 1) - 1;
    }
    return board;
}

Result<double> millimetres(const std::string& value)
{
    double number = 0;
    const auto read = std::from_chars(value.data(), value.data() + value.size(), number);
    if (value.empty() || read.ec != std::errc{} || read.ptr != value.data() + value.size())
        return failure(Fault::kUsage, "--square-mm %.40s: give the side of one square in millimetres, like 30 or 41.5",
                       value.c_str());
    return number;
}

/// Gives each board its square.
Status complete(Group& group)
{
    if (group.boards.size() != group.squares_mm.size())
        return failure(Fault::kUsage,
                       "%zu boards (--corners or --squares) and %zu sizes (--square-mm)%s%.100s: every board "
                       "needs both",
                       group.boards.size(), group.squares_mm.size(), group.folders.empty() ? "" : " for ",
                       group.folders.empty() ? "" : group.folders.back().c_str());
    for (std::size_t k = 0; k < group.boards.size(); ++k) {
        group.boards[k].square_mm = group.squares_mm[k];
        TRY(calibration::check_board(group.boards[k]));
    }
    return {};
}

} // namespace

Result<std::vector<PictureSet>> read_board_words(std::span<const BoardWord> words)
{
    std::vector<Group> groups(1); // the first is what stands before all folders
    for (const BoardWord& word : words) {
        if (word.kind == BoardWord::kImages) {
            if (groups.size() == 1 || groups.back().has_board())
                groups.emplace_back();
            std::string folder = word.value;
            while (folder.size() > 1 && folder.back() == '/')
                folder.pop_back();
            groups.back().folders.push_back(std::move(folder));
        } else if (word.kind == BoardWord::kSquareMm) {
            groups.back().squares_mm.push_back(TRY(millimetres(word.value)));
        } else {
            groups.back().boards.push_back(TRY(sides_of(word)));
        }
    }
    if (groups.size() == 1)
        return failure(Fault::kUsage, "calibrate: name a folder of pictures with --images");
    for (Group& group : groups)
        TRY(complete(group));

    const Group& all = groups.front();
    std::vector<PictureSet> sets;
    for (auto group = groups.begin() + 1; group != groups.end(); ++group) {
        if (!all.boards.empty() && !group->boards.empty())
            return failure(Fault::kUsage,
                           "boards stand before and after %.100s: name each folder first, then its board",
                           group->folders.front().c_str());
        const std::vector<Board>& boards = all.boards.empty() ? group->boards : all.boards;
        if (boards.empty())
            return failure(
                Fault::kUsage,
                "--images %.100s: say which board it shows: --corners 9x6 --square-mm 30 (or --squares 10x7)",
                group->folders.back().c_str());
        for (const std::string& folder : group->folders)
            sets.push_back({folder, boards});
    }
    return sets;
}

} // namespace dicot::app
