// Why a board was not found, in words for a person.
#pragma once

#include "dicot/calibration/board.h"
#include "lattice.h"

#include <string>

namespace dicot::calibration {

/// `best` is the largest lattice that was found (empty for none) in a level of width x height pixels.
std::string explain_miss(const Lattice& best, bool larger_board, const Board& board, int width, int height);

/// Why a picture shows nothing at all: too small, too dark, too bright, without contrast; else empty.
std::string explain_picture(ImageView<const std::uint8_t> grey);

} // namespace dicot::calibration
