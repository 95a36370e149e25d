// Small loops that are timed alone: the yardsticks of dicot bench.
#pragma once

#include "dicot/kernels/kernels.h"

namespace dicot::app {

/// Cycles a second of the core, from a chain of dependent additions (one cycle each on every CPU of interest).
double core_clock_hz();

/// Terms a second of the plainest float loop of eq. 13: precomputed weights, 35 x 35, one (p, d) after the other.
double float_loop_terms_per_s();

/// Terms a second of the aggregate kernel alone, at 64 disparities and 35 columns, tables in the cache.
double kernel_terms_per_s(const Kernels& kernels);

/// Terms a cycle that the multipliers of a current x86 core allow (two 256-bit integer multiplies a cycle; 2.5 of
/// them for 16 terms); 0 for kernels whose core is not known.
double peak_terms_per_cycle(const Kernels& kernels);

} // namespace dicot::app
