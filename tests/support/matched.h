// A matched pair that owns its memory.
#pragma once

#include "dicot/matching/matcher.h"

#include <memory>

namespace dicot {

class Matched
{
public:
    /// Matches with `workers` workers on as many threads, with the best kernels of this CPU unless told otherwise.
    /// Stops the test program with the reason when the options are refused.
    Matched(ImageView<const Rgb8> left, ImageView<const Rgb8> right, const MatchOptions& options,
            const Kernels* kernels = nullptr, int workers = 2);
    ~Matched();

    const DisparityMap& map() const { return outcome_.map; }
    const MatchTimes& times() const { return outcome_.times; }

private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
    MatchOutcome outcome_;
};

} // namespace dicot
