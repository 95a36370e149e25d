// Figures and names of a store, for a person. What a card says may have been written by anybody: it is shown escaped.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace dicot::app {

/// The first 255 bytes, as long as a reason may be, cut between characters: what is printable (dicot/base/printable.h)
/// as it is; of anything else the printable characters, "\\" for a backslash, and \x1B for every other byte.
std::string shown(std::string_view text);

/// "512 B", "4.1 KiB", "12.3 MiB", "1.5 GiB".
std::string shown_bytes(double bytes);

/// "1 folder", "2 folders"; `what` without its "s".
std::string counted(std::int64_t count, const char* what);

} // namespace dicot::app
