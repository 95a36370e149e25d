// One board's new snapshots into its folder of the archive, and the board told of them.
#pragma once

#include "pull_screen.h"

#include "dicot/pull_archive/pull_source.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace dicot::app {

struct PullWishes
{
    std::string archive;                  ///< folder around those of the boards
    bool verify = false;                  ///< what is there is hashed before it is believed
    bool all = false;                     ///< also what another computer has
    std::optional<std::int64_t> since_us; ///< by the board's clock
    bool set_clock = false;
    std::int64_t mark_patience_us = 90'000'000; ///< while the board is busy
};

struct PullReport
{
    std::string device, serial, where;
    std::int64_t offered = 0;      ///< snapshots that the source has
    std::int64_t fresh = 0;        ///< new in the archive
    std::uint64_t bytes = 0;       ///< of them
    std::int64_t there = 0;        ///< they were there already
    std::int64_t elsewhere = 0;    ///< left, as another computer has them
    std::int64_t earlier = 0;      ///< left, as they began before --since
    std::int64_t damaged = 0;      ///< at the source
    std::int64_t conflicts = 0;    ///< the archive has another one of the number
    std::int64_t gone = 0;         ///< pruned while we pulled
    std::int64_t unreadable = 0;   ///< the source failed
    std::int64_t damaged_here = 0; ///< and not taken anew: they stay
    std::int64_t put_aside = 0;    ///< damaged here, and taken anew
    std::int64_t marked = 0;       ///< the board knows now
    std::int64_t unmarked = 0;     ///< it was busy: the next pull tells it
    std::int64_t mark_refused = 0; ///< it says that it has others of these numbers
    bool takes_marks = true;       ///< a folder never does
    std::string marks_why;         ///< why it takes no marks; empty: it does
    std::string clock;             ///< what became of the time; empty: nobody asked
    Status outcome;
};

/// Names of this pull, so that two boards of one name are told apart before they meet in one folder.
class BoardNames
{
public:
    /// Fault::kBadData: another source of this pull has the name already.
    Status claim(const PullSource& source);

private:
    std::mutex mutex_;
    std::map<std::string, std::string> where_;
};

/// Whatever happens is in the report; troubles are said on the screen as they come.
PullReport pull_board(PullSource& source, const PullWishes& wishes, BoardNames& names, PullScreen& screen);

} // namespace dicot::app
