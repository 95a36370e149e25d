// PULLED: a line in a snapshot's folder, when a host had it whole.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"

#include <cstdint>
#include <string_view>

namespace dicot {

struct PulledMark
{
    std::int64_t pulled_us = 0; ///< since 1970, UTC; whole seconds
    ShortText<64> sums;         ///< SHA-256 of SHA256SUMS, as the host had it
};

using PulledText = ShortText<127>;

/// "2026-06-01T12:00:00Z <64 digits> <CRC-32 of what stands before>\n"
PulledText print_pulled(const PulledMark& mark);
/// Fault::kBadData: anything else.
Result<PulledMark> parse_pulled(std::string_view text);

} // namespace dicot
