// Semi-global paths up and down the columns, without a volume: a few rows of costs at a time.
#pragma once

#include "cost_rows.h"
#include "dicot/base/arena.h"

#include <algorithm>
#include <span>

namespace dicot::matching {

/// Rows come in chunks that the picture alone decides. The path downwards is carried from chunk to chunk; the path
/// upwards begins kAhead rows below each chunk, from where on it has forgotten where it began.
class ColumnPaths
{
public:
    static constexpr int kChunk = 8; ///< rows
    static constexpr int kAhead = 8; ///< rows

    /// How many rows of the picture the windows, `window` px high, of one chunk's new rows of costs cover at most.
    static constexpr int most_rows_at_once(int window)
    {
        return std::max(kChunk + window - 1, kChunk + kAhead + window / 2);
    }

    void lay_out(Arena& arena, const Scene& scene, int workers);

    /// Where the costs of row y, smoothed along the row, belong, [width][axis]. All rows up to `end_of_costs` must be
    /// there before `walk`.
    std::span<std::uint16_t> costs(const Scene& scene, int y);
    int end_of_costs(const Scene& scene, int chunk) const;

    /// Walks the columns of worker `worker` of `workers` and replaces the chunk's costs there by the mean of both
    /// paths; kNoCandidate stays. Chunks from top to bottom.
    void walk(const Scene& scene, int chunk, int worker, int workers);

private:
    static constexpr std::size_t kScratch = 4 + kChunk; ///< a column's path upwards, and steps

    std::span<std::uint16_t> ring_;    ///< [kChunk + kAhead][width][axis]
    std::span<std::uint16_t> behind_;  ///< [width][axis]: the path downwards where the last chunk ended
    std::span<std::uint16_t> least_;   ///< [width]
    std::span<std::uint16_t> scratch_; ///< [workers][kScratch][axis]
};

} // namespace dicot::matching
