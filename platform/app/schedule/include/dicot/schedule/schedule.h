// When snapshots are due.
#pragma once

#include "dicot/schedule/schedule_words.h"

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/os/time_zone.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dicot::app {

/// The section [schedule] of the configuration, as it is written.
struct ScheduleConfig
{
    std::string timezone;                      ///< as TimeZone::open() has it
    std::vector<std::string> at;               ///< Schedule::kMostMoments at most
    std::string every;                         ///< empty: not
    std::string from = "00:00";                ///< of `every`
    std::string until = "24:00";               ///< of `every`, included
    std::optional<double> latitude, longitude; ///< degrees, north and east are positive
    int late_min = 15;                         ///< a slot that could not begin until then is missed
};

/// One snapshot that is to be.
struct Slot
{
    std::int64_t due_us = 0; ///< UTC, whole seconds
    ShortText<15> why;       ///< the word of the schedule that it comes from: "06:30", "every 2h", "sunrise+30m"
};

/// A schedule, read and checked. Of fixed size, no heap.
struct Schedule
{
    static constexpr int kMostMoments = 48;

    struct NamedMoment
    {
        Moment moment;
        ShortText<15> word;
    };
    std::array<NamedMoment, kMostMoments> moments{};
    int moment_count = 0;
    int every_s = 0; ///< 0: not
    int from_s = 0, until_s = 86'400;
    ShortText<15> every_word;
    double latitude_deg = 0, longitude_deg = 0; ///< meaningless without a moment of the sun
    std::int64_t late_us = 0;

    bool empty() const noexcept { return moment_count == 0 && every_s == 0; }
    std::span<const NamedMoment> at() const noexcept
    {
        return std::span{moments}.first(static_cast<std::size_t>(moment_count));
    }
};

/// Keys of [schedule] that contradict each other.
struct Contradiction
{
    std::span<const char* const> keys;
    const char* why; ///< what contradicts what, and the remedy
};

/// None: the words go together. Each for itself they are as schedule_words.h has them.
std::optional<Contradiction> contradiction_in(const ScheduleConfig& words);

/// Fault::kConfig: a word that is none, too many of them, a contradiction.
Result<Schedule> make_schedule(const ScheduleConfig& words);

/// Slots in ascending order, one a due: what falls on the same second is one slot, with the word that stands first in
/// the configuration. `at` is wall time. `every` counts elapsed time from the day's `from` to the day's `until`, so the
/// spacing is the same on days of 23 and 25 hours. Both are taken as TimeZone::utc_us() takes them. Sunrise and sunset
/// are those of sun.h; a day without has no such slot. Borrows schedule and zone; no heap.
class SlotWalk
{
public:
    /// Begins with the first slot that is due after `after_us`.
    SlotWalk(const Schedule& schedule, const TimeZone& zone, std::int64_t after_us) noexcept;
    SlotWalk(const Schedule&&, const TimeZone&, std::int64_t) = delete; // it borrows
    SlotWalk(const Schedule&, const TimeZone&&, std::int64_t) = delete;

    /// None: the schedule is empty, or the sun neither rises nor sets for more than a year.
    std::optional<Slot> next() noexcept;

private:
    static constexpr std::int64_t kNever = INT64_MAX;

    std::int64_t moment_after(const Moment& moment, std::int64_t after_us) const noexcept;
    void find_every(std::int64_t after_us) noexcept;

    const Schedule& schedule_;
    const TimeZone& zone_;
    /// What next() has not given yet, or kNever.
    std::array<std::int64_t, Schedule::kMostMoments> moment_due_us_{};
    std::int64_t every_due_us_ = kNever;
    std::int64_t every_until_us_ = 0; ///< of that day
};

/// The earliest slot that is due after `after_us`. Pure.
std::optional<Slot> next_slot(const Schedule& schedule, const TimeZone& zone, std::int64_t after_us) noexcept;

} // namespace dicot::app
