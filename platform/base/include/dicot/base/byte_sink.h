// Where bytes go, one after the other.
#pragma once

#include "dicot/base/status.h"

#include <cstddef>
#include <span>

namespace dicot {

class ByteSink
{
public:
    virtual ~ByteSink() = default;

    /// All of them, or the Status that says why not; after a failure nothing more is to be written.
    virtual Status write(std::span<const std::byte> bytes) noexcept = 0;
};

} // namespace dicot
