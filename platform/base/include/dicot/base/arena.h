// Memory that is given at the start and never found on the way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace dicot {

/// Hands out pieces of one lent block, in order, and takes them all back at once.
///
/// Whatever needs memory has one `lay_out(Arena&)` that asks for its pieces. Run on a *measuring* arena (no block
/// behind it) it says how much it needs; run on a real one it gets it. So a prediction cannot drift from the use.
/// Pieces are aligned to 64 bytes, are not constructed, and are empty spans when the arena is too small: `overrun()`
/// tells, and the caller refuses to start. A need beyond all memory is counted as all of it.
class Arena
{
public:
    static constexpr std::size_t kAlignment = 64;

    /// An arena that only counts.
    Arena() noexcept = default;
    /// An arena over `block`, which must be aligned to kAlignment and must outlive every piece.
    explicit Arena(std::span<std::byte> block) noexcept : block_(block) {}

    template <typename T>
    std::span<T> take(std::size_t count) noexcept
    {
        static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kAlignment);
        const std::size_t start = used_;
        used_ = count > (kAll - used_) / sizeof(T)
                    ? kAll
                    : start + (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
        if (used_ > peak_)
            peak_ = used_;
        if (used_ > block_.size())
            return {};
        return {static_cast<T*>(static_cast<void*>(block_.data() + start)), count};
    }

    bool measuring() const noexcept { return block_.data() == nullptr; }
    bool overrun() const noexcept { return peak_ > block_.size(); }
    std::size_t used() const noexcept { return used_; }
    std::size_t peak() const noexcept { return peak_; }
    std::size_t size() const noexcept { return block_.size(); }

    /// Gives back everything taken since `mark` (a former value of used()).
    void rewind(std::size_t mark) noexcept { used_ = mark; }

private:
    /// Where counting ends: no block is as large, whatever the word size.
    static constexpr std::size_t kAll = SIZE_MAX / kAlignment * kAlignment;

    std::span<std::byte> block_{};
    std::size_t used_ = 0;
    std::size_t peak_ = 0;
};

} // namespace dicot
