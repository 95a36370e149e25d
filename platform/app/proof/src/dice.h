// Random inputs that a seed gives again: SplitMix64 (Steele, Lea, Flood 2014).
#pragma once

#include <cstdint>

namespace dicot::proof {

class Dice
{
public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next()
    {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
    /// 0 .. most.
    std::uint32_t up_to(std::uint32_t most)
    {
        return static_cast<std::uint32_t>(((next() >> 32) * (std::uint64_t{most} + 1)) >> 32);
    }
    int between(int least, int most)
    {
        return least + static_cast<int>(up_to(static_cast<std::uint32_t>(most - least)));
    }

private:
    std::uint64_t state_;
};

} // namespace dicot::proof
