// One picture, and which of the boards it shows.
#pragma once

#include "dicot/calibration/board.h"

#include <span>
#include <string>
#include <vector>

namespace dicot::app {

/// A name from a folder as a sentence may show it: control characters become question marks.
std::string shown_name(std::string name);

struct SeenPicture
{
    SeenPicture(std::string shown, std::string file, std::vector<int> tried)
        : name(std::move(shown)), path(std::move(file)), boards(std::move(tried)), sights(boards.size())
    {
    }

    /// Reads the picture and looks for its boards among `all`. May be called on any thread.
    void look(std::span<const calibration::Board> all);

    bool found(std::size_t board) const { return sights[board].found; }
    bool any_found() const;
    /// Why no board was found, without the picture's name.
    std::string reason() const;

    std::string name; ///< for sentences
    std::string path;
    std::vector<int> boards;                     ///< that it may show
    std::vector<calibration::BoardSight> sights; ///< one for each of them
    std::vector<std::string> titles;             ///< of the boards, where there are several
    std::string unreadable;                      ///< why it could not be read; empty when it could
};

} // namespace dicot::app
