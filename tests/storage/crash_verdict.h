// What must hold on a card after power loss, whatever was lost.
#pragma once

#include "crash_story.h"

#include <string>
#include <vector>

namespace dicot::test {

/// What is wrong, in sentences; none: all promises hold.
using Verdict = std::vector<std::string>;

struct Recovered
{
    Verdict verdict;
    Moment opened = 0; ///< when the repair was over, in the card's log; everything after it is the judge's
};

/// Opens the store on `card` as the board would after the power came back, and holds it to what `story` had promised
/// at `moment`. Stores one snapshot more, and opens it once more.
Recovered judge(CrashMedium& card, CrashVfs& vfs, const Story& story, Moment moment);

} // namespace dicot::test
