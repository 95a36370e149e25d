// The memory of one matching run: measured first, mapped once, never grown.
#pragma once

#include "dicot/base/image.h"
#include "dicot/matching/matcher.h"
#include "dicot/os/memory_block.h"

#include <cstddef>

namespace dicot::app {

/// What a run over pictures of one size needs, in bytes.
struct MatchBudget
{
    std::size_t pictures = 0; ///< both pictures
    std::size_t matcher = 0;  ///< tables, planes and maps
    std::size_t output = 0;   ///< the map as the output file wants it
    std::size_t total() const { return pictures + matcher + output; }
};

/// Errors: those of Matcher::check().
Result<MatchBudget> match_budget(int width, int height, const MatchOptions& options, int workers);

/// Two pictures and a matcher in one block.
class MatchBench
{
public:
    /// Errors: those of Matcher::check(); kOsError when the system has not that much memory.
    static Result<MatchBench> make(int width, int height, const MatchOptions& options, const Kernels& kernels,
                                   int workers);

    ImageView<Rgb8> left;
    ImageView<Rgb8> right;
    ImageView<std::uint16_t> output; ///< for a 16-bit picture of the map
    Matcher matcher;

private:
    MatchBench(MemoryBlock block, Matcher made) : matcher(std::move(made)), block_(std::move(block)) {}
    MemoryBlock block_;
};

} // namespace dicot::app
