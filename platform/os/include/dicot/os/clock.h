// Time for measuring: it never jumps, and it tells no date.
#pragma once

#include <cstdint>

namespace dicot {

std::int64_t monotonic_us() noexcept;   ///< since some fixed point
std::int64_t process_cpu_us() noexcept; ///< processor time of all threads of this process

} // namespace dicot
