// The rows of a match, from their costs to their winners: who does which, and when.
#pragma once

#include "bench.h"
#include "dicot/base/work.h"
#include "dicot/matching/matcher.h"

#include <atomic>

namespace dicot::matching {

class RowWork
{
public:
    RowWork(Bench& bench, const MatchOptions& options, const MatchHooks& hooks, int workers)
        : bench_(bench), options_(options), hooks_(hooks), workers_(workers)
    {
    }

    /// Every row of the picture.
    void run(Crew& crew);

private:
    /// One worker's bands, every row by itself.
    void match_bands(int worker);
    /// All workers in step: the costs of a chunk of rows and of those below it, its columns, its rows.
    void match_chunks(Crew& crew);
    void select(int y, Station& station, AggregatedRow costs);

    std::uint64_t clock() const { return hooks_.now_ns ? hooks_.now_ns() : 0; }
    Station& station(int worker) { return bench_.stations[static_cast<std::size_t>(worker)]; }

    Bench& bench_;
    const MatchOptions& options_;
    const MatchHooks& hooks_;
    int workers_;
    std::atomic<int> rows_done_{0};
};

} // namespace dicot::matching
