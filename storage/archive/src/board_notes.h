// Two small files of a board's folder: whose it is (BOARD), and what the source had at the last pull (LAST_PULL).
#pragma once

#include "dicot/base/status.h"
#include "dicot/medium/medium.h"
#include "dicot/pull_archive/board_archive.h"

#include <optional>
#include <string>
#include <string_view>

namespace dicot {

/// ARCHIVE, by which a store's writer knows that the folder is none of its own; synced. Fault::kIoError.
Status mark_archive(Medium& medium);

/// The board's serial number; empty: nobody noted one. Fault::kBadData, kIoError: it cannot be read.
Result<std::string> read_board(Medium& medium);
/// Written once, synced. Fault::kBadData: no line of printable text of 126 bytes at most; kIoError.
Status write_board(Medium& medium, std::string_view serial);

/// None: missing or damaged.
std::optional<LastPull> read_last_pull(Medium& medium);
/// Instead of what is there. Not synced: it only helps to explain. Fault::kIoError.
Status write_last_pull(Medium& medium, const LastPull& pull);

} // namespace dicot
