#include "dicot/schedule/schedule.h"
#include "dicot/schedule/sun.h"

#include "dicot/base/utc_time.h"

#include <algorithm>

namespace dicot::app {
namespace {

constexpr std::int64_t kSecondUs = 1'000'000;
constexpr std::int64_t kDayUs = 86'400 * kSecondUs;
constexpr int kDaysAround = 3;    // a slot of that day is due two days later at most, however its zone changes
constexpr int kMostSunDays = 372; // the longest polar day or night is over after half of that
constexpr std::int64_t kEarliestUs = kFirstUtcUs + 10 * kDayUs;
constexpr std::int64_t kLatestUs = kLastUtcUs - 800 * kDayUs;

} // namespace

SlotWalk::SlotWalk(const Schedule& schedule, const TimeZone& zone, std::int64_t after_us) noexcept
    : schedule_(schedule), zone_(zone)
{
    moment_due_us_.fill(kNever);
    if (after_us > kLatestUs)
        return;
    after_us = std::max(after_us, kEarliestUs);
    std::ranges::transform(
        schedule_.at(), moment_due_us_.begin(),
        [this, after_us](const Schedule::NamedMoment& named) { return moment_after(named.moment, after_us); });
    find_every(after_us);
}

std::int64_t SlotWalk::moment_after(const Moment& moment, std::int64_t after_us) const noexcept
{
    if (moment.after == Moment::After::kMidnight) {
        const std::int64_t today = zone_.local_day(after_us);
        for (std::int64_t day = today - kDaysAround; day <= today + kDaysAround; ++day)
            if (const std::int64_t due = zone_.utc_us(day, moment.seconds); due > after_us)
                return due;
        return kNever;
    }
    const SunEvent event = moment.after == Moment::After::kSunrise ? SunEvent::kRise : SunEvent::kSet;
    const std::int64_t distance_us = moment.seconds * kSecondUs;
    const std::int64_t today = solar_day(after_us - distance_us, schedule_.longitude_deg);
    for (std::int64_t day = today - 1; day <= today + kMostSunDays; ++day) {
        const auto found = sun_us(event, day, schedule_.latitude_deg, schedule_.longitude_deg);
        if (found && *found + distance_us > after_us)
            return *found + distance_us;
    }
    return kNever;
}

void SlotWalk::find_every(std::int64_t after_us) noexcept
{
    every_due_us_ = kNever;
    const std::int64_t step_us = schedule_.every_s * kSecondUs;
    if (step_us == 0)
        return;
    const std::int64_t today = zone_.local_day(after_us);
    for (std::int64_t day = today - kDaysAround; day <= today + kDaysAround; ++day) {
        const std::int64_t first = zone_.utc_us(day, schedule_.from_s);
        // Where clocks skip the time of `from`, it may come after `until`; the first slot of a day is always due.
        every_until_us_ = std::max(first, zone_.utc_us(day, schedule_.until_s));
        const std::int64_t due = first > after_us ? first : first + ((after_us - first) / step_us + 1) * step_us;
        if (due <= every_until_us_) {
            every_due_us_ = due;
            return;
        }
    }
}

std::optional<Slot> SlotWalk::next() noexcept
{
    const std::span<const Schedule::NamedMoment> moments = schedule_.at();
    const std::span<std::int64_t> dues = std::span{moment_due_us_}.first(moments.size());
    const auto first = std::ranges::min_element(dues);
    const bool by_moment = first != dues.end() && *first <= every_due_us_;
    const std::int64_t due = by_moment ? *first : every_due_us_;
    if (due == kNever)
        return std::nullopt;
    const Slot slot{due,
                    by_moment ? moments[static_cast<std::size_t>(first - dues.begin())].word : schedule_.every_word};

    if (by_moment)
        for (std::size_t i = 0; i < moments.size(); ++i)
            if (dues[i] == due)
                dues[i] = moment_after(moments[i].moment, due);
    if (every_due_us_ == due) {
        every_due_us_ += schedule_.every_s * kSecondUs;
        if (every_due_us_ > every_until_us_)
            find_every(due);
    }
    return slot;
}

std::optional<Slot> next_slot(const Schedule& schedule, const TimeZone& zone, std::int64_t after_us) noexcept
{
    return SlotWalk(schedule, zone, after_us).next();
}

} // namespace dicot::app
