// A line of text in place, without a heap.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace dicot {

/// Up to Capacity bytes of text, zero-terminated; what is longer is cut.
template <std::size_t Capacity>
class ShortText
{
public:
    static constexpr std::size_t kCapacity = Capacity;

    constexpr ShortText() noexcept = default;
    constexpr ShortText(std::string_view text) noexcept // NOLINT(google-explicit-constructor)
        : size_(std::min(text.size(), Capacity))
    {
        std::copy_n(text.data(), size_, bytes_);
    }
    constexpr ShortText(const char* text) noexcept
        : ShortText(std::string_view{text}) {} // NOLINT(google-explicit-constructor)

    constexpr bool empty() const noexcept { return size_ == 0; }
    constexpr const char* c_str() const noexcept { return bytes_; }
    constexpr std::string_view view() const noexcept { return {bytes_, size_}; }

    friend constexpr bool operator==(const ShortText& a, const ShortText& b) noexcept { return a.view() == b.view(); }

private:
    char bytes_[Capacity + 1] = {};
    std::size_t size_ = 0;
};

} // namespace dicot
