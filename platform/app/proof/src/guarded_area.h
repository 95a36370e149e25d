// Memory between two pages that nobody may touch.
#pragma once

#include "dicot/base/status.h"

#include <cstddef>
#include <span>
#include <utility>

namespace dicot::proof {

class GuardedArea
{
public:
    GuardedArea() = default;
    GuardedArea(GuardedArea&& other) noexcept { swap(other); }
    GuardedArea& operator=(GuardedArea&& other) noexcept
    {
        swap(other);
        return *this;
    }
    ~GuardedArea();

    /// At least `bytes`, with a page without any right before it and after it.
    static Result<GuardedArea> reserve(std::size_t bytes);

    std::span<std::byte> bytes() const { return usable_; }

private:
    void swap(GuardedArea& other)
    {
        std::swap(mapping_, other.mapping_);
        std::swap(usable_, other.usable_);
    }

    std::span<std::byte> mapping_{};
    std::span<std::byte> usable_{};
};

} // namespace dicot::proof
