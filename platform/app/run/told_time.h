// Time that is told, for rehearsals: rests take none.
#pragma once

#include "timekeeper.h"

namespace dicot::app {

class ToldTime final : public Timekeeper
{
public:
    /// Begins at `from_us`; goes on only by rests.
    explicit ToldTime(std::int64_t from_us) : now_us_(from_us) {}

    ClockReading now(std::optional<std::int64_t> newest_us) override;
    std::int64_t earliest_us() const override { return 0; }
    std::int64_t shift_us() const override;
    Woken begun() override { return {}; }
    std::int64_t begin_us(std::int64_t due_us) const override { return due_us - kLeadUs; }
    Woken rest(const RestWish& wish, FunctionRef<bool()> step) override;
    void pair_was_ready_after(std::int64_t) override {}

private:
    static constexpr std::int64_t kLeadUs = 5'000'000;
    std::int64_t now_us_;
};

} // namespace dicot::app
