// The bounds of the stages of a slot, and the watchdogs, which only progress feeds.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/os/hardware_watchdog.h"
#include "dicot/os/service_notice.h"
#include "dicot/os/stage_file.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace dicot {

struct StageWatchRules
{
    const char* device = "";            ///< of the hardware watchdog; empty: none
    int device_timeout_s = 180;         ///< as long as the supervisor bears silence
    const char* stage_file = "";        ///< empty: none
    std::int64_t grace_us = 60'000'000; ///< for a stage past its bound to hear overrun()
};

/// One at a time; the static words speak to the one that is open, and do nothing where none is, so that whatever works
/// in a slot may say them. A stage past its bound feeds nothing any more: overrun() says so, the stage is to end, and
/// enter() or leave() come next. One that has not ended after `grace_us` more ends the program with one sentence and
/// code 70, from a timer's signal (SIGRTMIN + 3), whatever the program is at. Time is CLOCK_MONOTONIC: sleep of the
/// whole board does not count. No heap.
class StageWatch
{
public:
    StageWatch() noexcept = default;
    StageWatch(const StageWatch&) = delete;
    StageWatch& operator=(const StageWatch&) = delete;
    ~StageWatch(); ///< a clean end: stopping() is said, the device is let go, the stage file says "none"

    /// Fault::kSoftware: there is one already. Any other failure is told, and the watch is open with the parts that it
    /// has: a supervisor that hears nothing would never let the program come up. The device's is device_trouble().
    Status open(const StageWatchRules& rules) noexcept;
    const Status& device_trouble() const noexcept { return device_trouble_; }
    const std::optional<StageEntry>& previous() const noexcept { return file_.previous(); } ///< StageFile::previous()

    /// The program is up: READY=1.
    void ready() noexcept { notice_.ready(); }
    void status(const char* text) noexcept { notice_.status(text); } ///< what `systemctl status` shows
    /// A sleep of the board is to come: where the kernel's monotonic clock runs on in it, the supervisor would take it
    /// for silence. 0: it is over.
    void bear(std::int64_t more_us) noexcept { notice_.bear(more_us); }
    /// How often progress() is to be said at least, to be on the safe side: a third of the least patient watchdog.
    std::int64_t most_silence_us() const noexcept;

    /// Which slot the stages are of from now on; forgets what overran.
    static void slot(std::uint64_t number, std::int64_t due_us) noexcept;
    /// A new stage begins, the last one is over. `bound_us` 0: no bound. Feeds.
    static void enter(const char* stage, std::int64_t bound_us) noexcept;
    /// No stage: rest. progress() goes on to feed.
    static void leave() noexcept;
    /// A step was made: a frame came, a band of rows is matched, a rest lasts. Feeds, at most once a second. Any
    /// thread.
    static void progress() noexcept;
    /// Whether this stage is past its bound. Any thread; cheap: a clock is read.
    static bool overrun() noexcept;
    /// "stage match is past its bound: 901 s of 900 s"; empty: nothing overran since slot().
    static ShortText<120> what_overran() noexcept;

    /// Around sleep of the board: a hardware watchdog that runs on meanwhile would reset it, so it is let go and held
    /// again.
    static void before_sleep() noexcept;
    static void after_sleep() noexcept;

private:
    static void cut_off(int) noexcept;
    Status open_timer() noexcept;
    void feed(std::int64_t now_us) noexcept;
    void arm(std::int64_t after_us) noexcept;
    void begin(const char* stage, std::int64_t bound_us) noexcept;
    bool past_bound(std::int64_t now_us) const noexcept;

    ServiceNotice notice_;
    HardwareWatchdog device_;
    StageFile file_;
    Status device_trouble_;
    std::int64_t grace_us_ = 0;
    int device_timeout_s_ = 0;
    ShortText<127> device_path_;
    bool open_ = false;
    bool has_timer_ = false;
    bool for_journal_ = false;
    timer_t timer_{};
    struct sigaction before_
    {
    };

    StageEntry now_;
    std::atomic<std::int64_t> began_us_{0};
    std::atomic<std::int64_t> bound_us_{0};
    std::atomic<std::int64_t> fed_us_{0};
    ShortText<120> overran_;
};

} // namespace dicot
