// Snapshots that are nobody's: sizes and bytes out of a seed, alike on every machine.
#pragma once

#include "dicot/base/byte_sink.h"
#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>

namespace dicot {

struct DrawnFile
{
    const char* name;
    std::size_t bytes;
};

/// What slot `number` of `seed` is to be.
struct DrawnSnapshot
{
    static constexpr int kFiles = 3;

    bool missed;
    std::int64_t began_us; ///< ten minutes apart, and now and then in 1970: a board whose clock was lost
    DrawnFile files[kFiles];
    int file_count;     ///< of these; the record comes behind them
    std::uint64_t root; ///< of the files' bytes
};

DrawnSnapshot draw_snapshot(std::uint64_t seed, int number);

/// The bytes of file `index`.
Status write_drawn(const DrawnSnapshot& snapshot, int index, ByteSink& sink);

} // namespace dicot
