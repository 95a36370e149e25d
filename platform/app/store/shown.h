// Figures and names of a store, for a person. What a card says may have been written by anybody: it is shown escaped.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace dicot::app {

/// What is printable (dicot/base/printable.h) and has 200 bytes at most as it is; of anything else the beginning, with
/// \x1B for every byte that is no printable ASCII.
std::string shown(std::string_view text);

/// "512 B", "4.1 KiB", "12.3 MiB", "1.5 GiB".
std::string shown_bytes(double bytes);

/// "1 folder", "2 folders"; `what` without its "s".
std::string counted(std::int64_t count, const char* what);

} // namespace dicot::app
