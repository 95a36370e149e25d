// Things that hang together: union and find over numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// Each thing names one of its group, the root itself.
class Groups
{
public:
    explicit Groups(std::span<std::int32_t> parent) : parent_(parent)
    {
        for (std::size_t i = 0; i < parent_.size(); ++i)
            parent_[i] = static_cast<std::int32_t>(i);
    }

    std::int32_t root(std::int32_t i)
    {
        while (at(i) != i) {
            at(i) = at(at(i));
            i = at(i);
        }
        return i;
    }

    /// The group of root i becomes part of that of root j.
    void hang(std::int32_t i, std::int32_t j) { at(i) = j; }

    /// The lesser of the two roots stays.
    void join(std::int32_t i, std::int32_t j)
    {
        i = root(i);
        j = root(j);
        (i < j ? at(j) : at(i)) = i < j ? i : j;
    }

private:
    std::int32_t& at(std::int32_t i) { return parent_[static_cast<std::size_t>(i)]; }

    std::span<std::int32_t> parent_;
};

} // namespace dicot
