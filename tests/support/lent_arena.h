// Memory for what takes its own from an arena.
#pragma once

#include "dicot/base/arena.h"

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace dicot::test {

/// An arena of exactly `bytes`, and the block behind it.
class LentArena
{
public:
    explicit LentArena(std::size_t bytes)
        : memory_(std::aligned_alloc(Arena::kAlignment,
                                     (bytes + Arena::kAlignment - 1) / Arena::kAlignment * Arena::kAlignment),
                  &std::free),
          arena_({static_cast<std::byte*>(memory_.get()), bytes})
    {
    }
    Arena& arena() { return arena_; }

private:
    std::unique_ptr<void, void (*)(void*)> memory_;
    Arena arena_;
};

} // namespace dicot::test
