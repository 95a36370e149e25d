// The time of the board, its sleep and its alarm.
#pragma once

#include "timekeeper.h"

#include "../config/config.h"
#include "dicot/power/lead_time.h"
#include "dicot/power/linux_board.h"

namespace dicot::app {

class BoardTime final : public Timekeeper
{
public:
    explicit BoardTime(const Config& config);

    ClockReading now(std::optional<std::int64_t> newest_us) override { return read_clock(newest_us); }
    Woken begun() override { return rest_.begun(); }
    std::int64_t begin_us(std::int64_t due_us) const override { return rest_.begin_us(due_us); }
    Woken rest(const RestWish& wish, FunctionRef<bool()> step) override { return rest_.until(wish, step); }
    void pair_was_ready_after(std::int64_t us) override;

private:
    LinuxBoard board_;
    LeadTime lead_;
    Rest rest_;
};

} // namespace dicot::app
