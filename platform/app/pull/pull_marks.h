// Telling a board what is verified and synced here.
#pragma once

#include "pull_board.h"

#include "dicot/pull_archive/pull_source.h"

#include <cstdint>
#include <vector>

namespace dicot::app {

/// Collects marks and tells the source in batches. The archive is the truth: what could not be told is told by the next
/// pull.
class PullMarks
{
public:
    static constexpr std::size_t kBatch = 512;

    PullMarks(PullSource& source, PullReport& report, std::int64_t patience_us)
        : source_(source), report_(report), patience_us_(patience_us)
    {
    }

    /// Tells the source when a batch is full.
    void add(const PullSource::Pulled& pulled);
    /// Tells it of all that is left, waiting for a busy board if `patient`.
    void tell(bool patient);

private:
    void tell(std::span<const PullSource::Pulled> batch, bool patient);
    Status mark_patiently(std::span<const PullSource::Pulled> batch, bool patient);

    PullSource& source_;
    PullReport& report_;
    std::int64_t patience_us_;
    std::vector<PullSource::Pulled> waiting_;
    bool takes_marks_ = true;
};

} // namespace dicot::app
