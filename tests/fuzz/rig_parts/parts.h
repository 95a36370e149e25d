// What the parts of the camera rig have in common under the fuzzer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

namespace dicot::fuzz {

inline void require(bool promise)
{
    if (!promise)
        std::abort();
}

/// One line of printable ASCII.
inline void require_sentence(const char* text)
{
    require(*text != '\0');
    for (; *text != '\0'; ++text)
        require(*text >= ' ' && *text <= '~');
}

/// Input as numbers; zeros behind its end.
class Numbers
{
public:
    explicit Numbers(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    bool empty() const { return bytes_.empty(); }
    std::uint8_t byte()
    {
        if (bytes_.empty())
            return 0;
        const std::uint8_t first = bytes_.front();
        bytes_ = bytes_.subspan(1);
        return first;
    }
    std::uint16_t word() { return static_cast<std::uint16_t>(byte() | byte() << 8); }
    std::uint32_t number()
    {
        const std::uint32_t low = word();
        return low | std::uint32_t{word()} << 16;
    }
    std::uint64_t large()
    {
        const std::uint64_t low = number();
        return low | std::uint64_t{number()} << 32;
    }

private:
    std::span<const std::uint8_t> bytes_;
};

void plan(Numbers& numbers);         ///< bandwidth.h
void pair(Numbers& numbers);         ///< camera_rig/pairing.h
void climb_ladder(Numbers& numbers); ///< camera_rig/ladder.h

} // namespace dicot::fuzz
