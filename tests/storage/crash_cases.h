// One recorded story, cut wherever the power may go.
#pragma once

#include "crash_story.h"
#include "crash_verdict.h"

#include <optional>
#include <string>
#include <vector>

namespace dicot::test {

/// The card's log of an uncut run. That run up to its Nth change is the run cut at its Nth change.
struct Recording
{
    Story story;
    std::vector<Change> log;
};

/// SQLite's memory comes with the first catalogue, so it must come before the CrashVfs.
class CrashScene
{
public:
    CrashScene();

    Recording record(const StoryRules& rules = {});
    /// Nothing but small snapshots.
    Recording record_many(int slots);
    CrashVfs& vfs() { return *vfs_; }

private:
    std::unique_ptr<CrashVfs> vfs_;
};

/// "subset:37:5", or with a second cut, during the repair after the first one, "subset:37:5+torn:12:3".
struct CrashCase
{
    Cut cut;
    std::optional<Cut> repair_cut;

    std::string text() const;
    static std::optional<CrashCase> parse(const std::string& text);
};

/// What the judge says after it.
Verdict run_case(CrashVfs& vfs, const Recording& recording, const CrashCase& which);

/// The case's id, and under it the sentences.
std::string words_of(const CrashCase& which, const Verdict& verdict);

struct CrashPlan
{
    Cut::Mode mode = Cut::Mode::kInOrder;
    unsigned seeds = 1;
    std::size_t repairs_every = 0; ///< of so many states, one has its repair cut too, in every mode; 0: none
    Moment from = 0;               ///< where the first cut is
    std::size_t most_failures = 8; ///< then it ends
};

struct CrashReport
{
    std::size_t cuts = 0, states = 0; ///< states that are alike are judged once
    std::size_t repair_states = 0;
    std::vector<std::string> failures; ///< each begins with the case's id
};

/// Cuts at each change of the recording.
CrashReport run_plan(CrashVfs& vfs, const Recording& recording, const CrashPlan& plan);

} // namespace dicot::test
