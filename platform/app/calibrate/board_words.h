// Folders and boards as the command line names them.
#pragma once

#include "calibration_run.h"

#include <span>
#include <string>
#include <vector>

namespace dicot::app {

/// One of --images, --corners, --squares and --square-mm, in the order in which they were given.
struct BoardWord
{
    enum Kind
    {
        kImages,
        kCorners,
        kSquares,
        kSquareMm
    };
    Kind kind = kImages;
    std::string value;
};

/// Boards belong to the folders named before them, back to the last board; boards that stand before all folders belong
/// to every folder. Every board has its inner corners (or squares) and, after or before that, its --square-mm.
/// Fault::kUsage: a board that cannot be looked for, numbers that are none, a folder without a board.
Result<std::vector<PictureSet>> read_board_words(std::span<const BoardWord> words);

} // namespace dicot::app
