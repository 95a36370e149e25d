// What a command of this program would print.
#pragma once

#include "dicot/base/status.h"

#include <string>
#include <vector>

namespace dicot::app {

struct Told
{
    std::string text;    ///< what went to standard output
    std::string remarks; ///< and to standard error
    Status status;       ///< what the command came to
};

/// Runs one of the commands that look and change nothing, in this process; `words` as on the command line, the
/// command's name first. Fault::kUsage: there is no such command, or it does not know a word.
Told told_by(std::vector<std::string> words);

} // namespace dicot::app
