// Memory straight from the system: what the arenas are carved from.
#pragma once

#include "dicot/base/status.h"

#include <cstddef>
#include <span>

namespace dicot {

class MemoryReserve;

enum class Pages
{
    kOnTouch,  ///< a page becomes resident when it is first written
    kResident, ///< every page is resident before map() returns: running out is found out now
};

/// A private block of zeroed pages, given back when it is let go: the system's, or of the MemoryReserve that there is.
class MemoryBlock
{
public:
    MemoryBlock() noexcept = default; ///< an empty block
    MemoryBlock(MemoryBlock&& other) noexcept;
    MemoryBlock& operator=(MemoryBlock&& other) noexcept;
    ~MemoryBlock();

    /// At least `bytes` bytes, aligned to a page. 0 bytes make an empty block. Fault::kOsError: the system, or
    /// the reserve, has no more.
    static Result<MemoryBlock> map(std::size_t bytes, Pages pages = Pages::kOnTouch) noexcept;

    std::span<std::byte> bytes() const noexcept { return bytes_; } ///< exactly as many as were asked for

private:
    std::span<std::byte> bytes_{};
    MemoryReserve* reserve_ = nullptr; ///< where they go back to; null: to the system
};

} // namespace dicot
