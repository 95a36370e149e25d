// What every command that measures a board wants alike, so that they share what was measured.
#pragma once

#include "board_traits.h"

#include <string>

namespace dicot::app {

/// `places`: file of --plants; empty: none. With the usual cache, made by this very program. Errors: those of
/// read_plant_places(), digest_of_file() and cache_maker().
Result<TraitsWishes> usual_wishes(const std::string& places);

} // namespace dicot::app
