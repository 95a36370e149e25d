// Where the figures go: drawn anew in place on a terminal, a line a second elsewhere.
#pragma once

#include "aim_figures.h"

#include "dicot/base/status.h"

#include <cstdint>
#include <string>

namespace dicot::app {

/// Writes to stdout. Every call that writes may fail: Fault::kIoError.
class AimScreen
{
public:
    explicit AimScreen(bool json) noexcept;

    /// How often it wants to be told.
    std::int64_t interval_us() const noexcept { return in_place_ ? 250'000 : 1'000'000; }
    Status show(const AimMoment& now);
    Status end(const AimMoment& last);

private:
    Status draw(const AimMoment& now);

    bool json_;
    bool in_place_;
    bool colours_;
    int drawn_ = 0; ///< lines of the block that stands on the terminal
};

} // namespace dicot::app
