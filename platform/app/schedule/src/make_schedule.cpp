#include "dicot/schedule/schedule.h"

#include <algorithm>

namespace dicot::app {
namespace {

bool is_of_sun(const std::string& word)
{
    const std::optional<Moment> moment = parse_moment(word);
    return moment && moment->after != Moment::After::kMidnight;
}

Status no_word(const char* key, const std::string& word)
{
    return failure(Fault::kConfig,
                   "[schedule] %s is \"%.40s\", which says no time: dicot config --sample shows what may be", key,
                   word.c_str());
}

} // namespace

std::optional<Contradiction> contradiction_in(const ScheduleConfig& words)
{
    static constexpr const char* kSunKeys[] = {"at", "latitude", "longitude"};
    static constexpr const char* kSpanKeys[] = {"from", "until"};
    static constexpr const char* kEveryKeys[] = {"every", "from", "until"};
    const int from_s = parse_clock_s(words.from).value_or(0);
    const int until_s = parse_clock_s(words.until).value_or(0);
    const int every_s = parse_duration_s(words.every).value_or(0);

    if (std::ranges::any_of(words.at, is_of_sun) && !(words.latitude && words.longitude))
        return Contradiction{kSunKeys,
                             "at tells times by the sun, which depend on the place: give latitude and longitude"};
    if (from_s >= until_s)
        return Contradiction{kSpanKeys, "from is not before until: both are times of one day, and 24:00 is its end"};
    if (every_s > until_s - from_s)
        return Contradiction{kEveryKeys,
                             "every is longer than from from to until, so it has no room: for one time a day "
                             "give at"};
    return std::nullopt;
}

Result<Schedule> make_schedule(const ScheduleConfig& words)
{
    if (const std::optional<Contradiction> found = contradiction_in(words))
        return failure(Fault::kConfig, "[schedule] %s", found->why);
    Schedule schedule;
    if (words.at.size() > schedule.moments.size())
        return failure(Fault::kConfig, "[schedule] at has %zu times: give %d at most", words.at.size(),
                       Schedule::kMostMoments);
    for (const std::string& word : words.at) {
        const std::optional<Moment> moment = parse_moment(word);
        if (!moment)
            return no_word("at", word);
        schedule.moments[static_cast<std::size_t>(schedule.moment_count++)] = {*moment, std::string_view{word}};
    }
    if (!is_interval(words.every))
        return no_word("every", words.every);
    schedule.every_s = parse_duration_s(words.every).value_or(0);
    schedule.every_word = std::string_view{"every " + words.every};
    schedule.from_s = parse_clock_s(words.from).value_or(0);
    schedule.until_s = parse_clock_s(words.until).value_or(0);
    schedule.latitude_deg = words.latitude.value_or(0);
    schedule.longitude_deg = words.longitude.value_or(0);
    schedule.late_us = std::int64_t{words.late_min} * 60 * 1'000'000;
    return schedule;
}

} // namespace dicot::app
