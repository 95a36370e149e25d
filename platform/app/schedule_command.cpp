// dicot schedule: when snapshots are due.
#include "commands.h"
#include "config_words.h"
#include "store/shown.h"
#include "store/slot_words.h"

#include "dicot/schedule/schedule.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/clock_trust.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace dicot::app {
namespace {

using nlohmann::json;

struct ScheduleWords
{
    ConfigWords config;
    int next = 10;
    std::string from;
    bool json = false;
};

/// What is asked about: all of it.
struct Question
{
    Schedule schedule;
    TimeZone zone;
    std::int64_t from_us;
    ClockTrust clock;

    std::vector<Slot> slots(int most) const
    {
        std::vector<Slot> found;
        SlotWalk walk(schedule, zone, from_us - 1);
        while (found.size() < static_cast<std::size_t>(most))
            if (const std::optional<Slot> slot = walk.next())
                found.push_back(*slot);
            else
                break;
        return found;
    }
};

Result<Question> question_of(const ScheduleWords& words)
{
    const LoadedConfig loaded = TRY(words.config.load());
    const ScheduleConfig& config = loaded.config.schedule;
    const ClockReading now = read_clock({});
    Question question{TRY(make_schedule(config)), TRY(TimeZone::open(config.timezone)), now.now_us, now.trust};
    if (words.from.empty())
        return question;
    const std::optional<TimeSpan> from = parse_time(words.from);
    if (!from)
        return failure(Fault::kUsage, "--from is %s: give a day or a time in UTC, as 2026-06-01 or 2026-06-01T12:30",
                       shown(words.from).c_str());
    question.from_us = from->first_us;
    return question;
}

/// "2026-06-01T06:30:00", as local clocks show it.
std::string local_text(const TimeZone& zone, std::int64_t utc_us)
{
    return std::string{utc_text(zone.local_us(utc_us)).view().substr(0, 19)};
}

void print(const Question& question, const std::vector<Slot>& slots)
{
    const TimeZone& zone = question.zone;
    if (question.schedule.empty()) {
        std::printf(
            "no snapshot is due: [schedule] has no times; give at or every (dicot config --sample shows how)\n");
        return;
    }
    std::printf("local time of %s; a snapshot that could not begin within %lld min is missed\n",
                shown(zone.name()).c_str(), static_cast<long long>(question.schedule.late_us / 60'000'000));
    if (slots.empty())
        std::printf("no snapshot is due for a year: the sun neither rises nor sets there\n");
    else
        std::printf("\n%-19s  %-6s  %-20s  %s\n", "local time", "offset", "UTC", "why");
    for (const Slot& slot : slots) {
        std::string local = local_text(zone, slot.due_us);
        local[10] = ' ';
        std::printf("%-19s  %-6s  %-20s  %s\n", local.c_str(), offset_text(zone.offset_s(slot.due_us)).c_str(),
                    utc_text(slot.due_us).c_str(), slot.why.c_str());
    }
}

json json_of(const Question& question, const std::vector<Slot>& slots)
{
    const TimeZone& zone = question.zone;
    json list = json::array();
    for (const Slot& slot : slots)
        list.push_back({{"due", utc_text(slot.due_us).c_str()},
                        {"local", local_text(zone, slot.due_us) + offset_text(zone.offset_s(slot.due_us)).c_str()},
                        {"why", slot.why.c_str()}});
    return {{"timezone", zone.name()},
            {"from", utc_text(question.from_us).c_str()},
            {"clock", name_of(question.clock)},
            {"late_min", question.schedule.late_us / 60'000'000},
            {"slots", list}};
}

Status run(const ScheduleWords& words)
{
    const Question question = TRY(question_of(words));
    const std::vector<Slot> slots = question.slots(words.next);
    if (words.json) {
        std::printf("%s\n", json_text(json_of(question, slots)).c_str());
        return {};
    }
    print(question, slots);
    if (words.from.empty() && question.clock == ClockTrust::kNotSet)
        std::printf("\nthe clock is not set: it shows %s\n", utc_text(question.from_us).c_str());
    return {};
}

} // namespace

void add_schedule(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("schedule", "When the next snapshots are due, in local time and in UTC");
    auto words = std::make_shared<ScheduleWords>();
    command->add_option("--next", words->next, "how many (default: 10)")->check(CLI::Range(1, 100'000));
    command->add_option("--from", words->from, "from this day or time on, UTC (default: now)")->type_name("TIME");
    words->config.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
