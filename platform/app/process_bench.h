// The memory of one pair's way to a cloud: measured first, mapped once, never grown.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/cloud.h"
#include "dicot/matching/matcher.h"
#include "dicot/os/memory_block.h"

#include <cstddef>
#include <span>

namespace dicot::app {

/// What a run over pictures of one size needs, in bytes. The three stages use the same memory, one after the other.
struct ProcessBudget
{
    std::size_t tables = 0; ///< rectification: mapped apart, before the rest
    std::size_t kept = 0;   ///< a point for each pixel
    std::size_t match =
        0; ///< stage 1: both pictures, picture of the disparities, and then what they come from or the matcher
    std::size_t encode = 0;  ///< stage 2: the compressor's heap
    std::size_t preview = 0; ///< stage 3: the drawing of the cloud
    std::size_t stages() const;
    std::size_t total() const { return tables + kept + stages(); }
};

/// Size of the drawing: two views beside each other, shaped like the pictures.
struct PreviewSize
{
    int width = 0;
    int height = 0;
};
PreviewSize preview_size(int width, int height);

/// Whether the pictures come from the cameras as they are, or are rectified already.
enum class Pictures
{
    kRaw,
    kRectified
};

/// `scratch_bytes`: what getting the pictures takes beside them. Errors: those of Matcher::check(); kConfig when the
/// pictures could give more points than a file holds.
Result<ProcessBudget> process_budget(int width, int height, Pictures pictures, const MatchOptions& options, int workers,
                                     std::size_t scratch_bytes = 0);

/// The memory but for the tables, cut into what is kept and what the stages use in turn. Pages become resident when
/// they are used.
class ProcessBench
{
public:
    /// Errors: those of process_budget(); kOsError when the system has not that much memory.
    static Result<ProcessBench> make(int width, int height, Pictures pictures, const MatchOptions& options, int workers,
                                     std::size_t scratch_bytes = 0);

    Arena kept;
    /// An arena over the stages' memory; what the stage before took is gone.
    Arena next_stage() const { return Arena{stages_}; }
    const ProcessBudget& budget() const { return budget_; }

private:
    ProcessBench(MemoryBlock block, const ProcessBudget& budget);

    MemoryBlock block_;
    std::span<std::byte> stages_;
    ProcessBudget budget_;
};

} // namespace dicot::app
