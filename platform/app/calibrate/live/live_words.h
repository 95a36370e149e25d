// The figures of a live calibration as text. Pure: no terminal, no clock.
#pragma once

#include "live_guide.h"

#include <cstdint>
#include <string>

namespace dicot::app {

/// One moment of it.
struct LiveMoment
{
    int kept = 0;
    int wanted = 0;
    LiveSight sight = LiveSight::kUnseen;
    std::int64_t still_us = 0;
    std::int64_t skew_us = 0;
    double looks_per_s = 0;   ///< pairs that are looked at
    std::int64_t left_us = 0; ///< until the run ends by itself
    std::string advice;
    LiveCoverage coverage;
};

/// `text` in lines of at most `columns` characters, broken at blanks; each line but the first is indented by `indent`.
/// A word that is too long gets a line of its own.
std::string wrapped(const std::string& text, int columns, int indent);

/// Several lines that say where the run stands and what to do next; for a terminal, with or without colours. No line
/// is longer than `columns`, 40 at least, and each ends with a line feed.
std::string live_block(const LiveMoment& now, int columns, bool colours);

/// One line for a file or a pipe, without a line feed.
std::string live_line(const LiveMoment& now);

/// One line of JSON, without a line feed; `event` is "look" or "pair", `picture` the name of a pair's left picture.
std::string live_json(const LiveMoment& now, const char* event, const std::string& picture);

} // namespace dicot::app
