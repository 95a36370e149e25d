// The figures of two cameras as text: a block for a terminal, a line, a JSON object.
#pragma once

#include "aim_figures.h"

#include <string>

namespace dicot::app {

/// As printf would write it, up to 400 bytes.
std::string text_of(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// A block of lines, each ended by a newline and none wider than `columns`. Made for 60 columns; wider terminals get
/// longer lines of advice.
std::string aim_block(const AimMoment& now, int columns, bool colours);

/// One line without its newline: the figures, then the most important thing to do.
std::string aim_line(const AimMoment& now);

/// What stands at the end: a line, and with `advice` a line for each thing left to do.
std::string aim_summary(const AimMoment& last, bool advice);

/// One object on one line, without the newline. What is not known is null.
std::string aim_json(const AimMoment& now);
std::string aim_summary_json(const AimMoment& last);

} // namespace dicot::app
