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
    due_us_.fill(kNever);
    if (after_us > kLatestUs)
        return;
    after_us = std::max(after_us, kEarliestUs);
    for (int source = 0; source < schedule_.moment_count; ++source)
        find_moment(source, after_us);
    find_every(after_us);
}

void SlotWalk::find_moment(int source, std::int64_t after_us) noexcept
{
    const auto at = static_cast<std::size_t>(source);
    const Moment& moment = schedule_.moments[at].moment;
    std::int64_t& due = due_us_[at];
    due = kNever;
    if (moment.after == Moment::After::kMidnight) {
        const std::int64_t today = zone_.local_day(after_us);
        for (std::int64_t day = today - kDaysAround; day <= today + kDaysAround && due == kNever; ++day)
            if (const std::int64_t found = zone_.utc_us(day, moment.seconds); found > after_us)
                due = found;
        return;
    }
    const SunEvent event = moment.after == Moment::After::kSunrise ? SunEvent::kRise : SunEvent::kSet;
    const std::int64_t distance_us = moment.seconds * kSecondUs;
    const std::int64_t today = solar_day(after_us - distance_us, schedule_.longitude_deg);
    for (std::int64_t day = today - 1; day <= today + kMostSunDays && due == kNever; ++day) {
        const auto found = sun_us(event, day, schedule_.latitude_deg, schedule_.longitude_deg);
        if (found && *found + distance_us > after_us)
            due = *found + distance_us;
    }
}

void SlotWalk::find_every(std::int64_t after_us) noexcept
{
    std::int64_t& due = due_us_.back();
    due = kNever;
    const std::int64_t step_us = schedule_.every_s * kSecondUs;
    const std::int64_t today = zone_.local_day(after_us);
    for (std::int64_t day = today - kDaysAround; step_us > 0 && day <= today + kDaysAround && due == kNever; ++day) {
        const std::int64_t first = zone_.utc_us(day, schedule_.from_s);
        // Where clocks skip the time of `from`, it may come after `until`; the first slot of a day is always due.
        every_until_us_ = std::max(first, zone_.utc_us(day, schedule_.until_s));
        const std::int64_t found = first > after_us ? first : first + ((after_us - first) / step_us + 1) * step_us;
        if (found <= every_until_us_)
            due = found;
    }
}

std::optional<Slot> SlotWalk::next() noexcept
{
    const auto first = std::ranges::min_element(due_us_);
    const std::int64_t due = *first;
    if (due == kNever)
        return std::nullopt;
    const auto place = static_cast<std::size_t>(first - due_us_.begin());
    const bool by_every = first == due_us_.end() - 1;
    const Slot slot{due, by_every ? schedule_.every_word : schedule_.moments[place].word};

    for (int source = 0; source < schedule_.moment_count; ++source)
        if (due_us_[static_cast<std::size_t>(source)] == due)
            find_moment(source, due);
    if (due_us_.back() == due) {
        due_us_.back() += schedule_.every_s * kSecondUs;
        if (due_us_.back() > every_until_us_)
            find_every(due);
    }
    return slot;
}

std::optional<Slot> next_slot(const Schedule& schedule, const TimeZone& zone, std::int64_t after_us) noexcept
{
    return SlotWalk(schedule, zone, after_us).next();
}

} // namespace dicot::app
