// The pause between two slots: idle, suspended or powered off.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/os/suspend.h"
#include "dicot/os/wait.h"
#include "dicot/power/lead_time.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace dicot::app {

enum class Between
{
    kIdle,
    kSuspend,
    kOff,
};
const char* name_of(Between way) noexcept; ///< "idle", "suspend", "off"

enum class WakeReason
{
    kTime,         ///< it was awake: the time came
    kAlarm,        ///< the alarm of the board's clock
    kOther,        ///< something else woke the sleeping board, or the program was started while the board was up
    kPowerOn,      ///< power came back, or somebody switched the board on
    kClockChanged, ///< the system's clock was set: plan anew
    kAsked,        ///< somebody wants an end
};
const char* name_of(WakeReason reason) noexcept; ///< "time", "alarm", "other", "power on", "clock changed", "asked"

struct RestWish
{
    std::int64_t due_us = 0; ///< when the pair is to be taken, since 1970, UTC
    std::uint64_t slot = 0;  ///< its number, for the mark; 0: not known
};

struct Woken
{
    WakeReason reason = WakeReason::kTime;
    Between way = Between::kIdle; ///< the deepest that was reached
    std::int64_t asleep_us = 0;   ///< of the board, in this pause
    ShortText<63> woken_by;       ///< the interrupt, as the kernel names it
    ShortText<255> trouble;       ///< why it was not as configured: one sentence, each cause told once
};

struct RestRules
{
    Between between = Between::kIdle;
    std::int64_t least_rest_us = 120'000'000;      ///< shorter pauses are idled
    std::int64_t awake_first_us = 0;               ///< after a start: so long it does not sleep
    std::int64_t step_us = 20'000'000;             ///< at most between two calls of `step`
    std::int64_t unanswered_us = 300'000'000;      ///< a request to power off is withdrawn after so long
    ShortText<255> state = "/var/lib/dicot/state"; ///< folder of the mark
    ShortText<127> request = "/run/dicot/power-off";
};

/// What the rest is made of; LinuxBoard below is the one of the field.
class Board
{
public:
    virtual ~Board() = default;

    virtual std::int64_t now_us() noexcept = 0;      ///< UTC, what the system's clock shows
    virtual std::int64_t boottime_us() noexcept = 0; ///< since the start, sleep included
    virtual BootId boot() noexcept = 0;
    virtual WaitEnd wait_until(std::int64_t until_us, std::int64_t step_us, FunctionRef<bool()> step) noexcept = 0;
    virtual Status wake_after(std::int64_t after_s) noexcept = 0; ///< the alarm
    virtual Status no_alarm() noexcept = 0;
    virtual Result<Slept> suspend() noexcept = 0;
    /// A computer is at the cable and awake: it would lose the board in the middle of a file.
    virtual bool computer_is_there() noexcept { return false; }
};

/// One rest after the other. Nothing that fails ends the series: what cannot suspend or be powered off idles, and says
/// why. `state` and `request` are files; no heap.
class Rest
{
public:
    Rest(Board& board, LeadTime& lead, const RestRules& rules) noexcept;

    /// How this start came about: the mark that the last one left, compared with this boot. Call it once, first.
    /// `way` is kOff if the board was off by its own wish; `trouble`: the mark could not be written.
    Woken begun() noexcept;

    /// A start that is not the alarm's work is somebody's: for ten minutes after it the board is not powered off. While
    /// a computer is at the cable it neither sleeps nor is powered off. Such a rest ends early, as kTime. Else: rests
    /// until it is time to begin the slot, begin_us(), or until something else comes up. `step` is called each
    /// `step_us` and after each signal: whether to go on. Where the board is powered off, it returns with kAsked alone,
    /// as the system stops its services; or as idle, if nobody answers the request.
    Woken until(const RestWish& wish, FunctionRef<bool()> step) noexcept;

    /// The way that a pause would go that begins now.
    Between way_to(std::int64_t due_us) noexcept;
    /// When the slot begins: the cameras' lead before it is due.
    std::int64_t begin_us(std::int64_t due_us) const noexcept;

private:
    enum class Next
    {
        kIdle, ///< the rest of the pause is idled
        kOver, ///< the pause is over: `reason` says why
    };
    /// By boottime_us(): until then the board neither sleeps nor is powered off; 0: it may.
    std::int64_t stays_on_until_us() noexcept;
    void idle(std::int64_t until_us, FunctionRef<bool()> step, Woken& woken) noexcept;
    Next suspend(std::int64_t begin_us, FunctionRef<bool()> step, Woken& woken) noexcept;
    Next power_off(const RestWish& wish, FunctionRef<bool()> step, Woken& woken) noexcept;
    Next await_power_off(std::int64_t most_us, FunctionRef<bool()> step, Woken& woken) noexcept;
    Status write_mark(std::uint64_t slot, std::int64_t due_us, std::int64_t alarm_us) noexcept;
    void tell(const Status& why, Woken& woken) noexcept;

    Board& board_;
    LeadTime& lead_;
    RestRules rules_;
    ShortText<255> mark_;
    std::int64_t awake_until_us_ = 0; ///< by boottime_us(): before that it does not sleep
    std::int64_t on_until_us_ = 0;    ///< by boottime_us(): before that the board is not powered off
    ShortText<255> told_;             ///< the last trouble, so that it is told once
};

} // namespace dicot::app
