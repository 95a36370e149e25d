#include "dicot/replay/replay_script.h"

#include <charconv>
#include <limits>

namespace dicot {
namespace {

std::string_view next_word(std::string_view& line) noexcept
{
    constexpr std::string_view kBlank = " \t\r";
    const std::size_t from = std::min(line.find_first_not_of(kBlank), line.size());
    line.remove_prefix(from);
    const std::size_t length = std::min(line.find_first_of(kBlank), line.size());
    const std::string_view word = line.substr(0, length);
    line.remove_prefix(length);
    return word;
}

bool read_number(std::string_view& line, std::int64_t least, std::int64_t most, std::int64_t& number) noexcept
{
    const std::string_view word = next_word(line);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return !word.empty() && error == std::errc{} && end == word.data() + word.size() && number >= least &&
           number <= most;
}

constexpr std::int64_t kMostFrames = 1'000'000'000;

struct FaultWord
{
    std::string_view word;
    ReplayFault fault;
};
constexpr FaultWord kFaults[] = {
    {"drop", ReplayFault::kDrop},
    {"torn", ReplayFault::kTorn},
    {"hang", ReplayFault::kHang},
    {"gone", ReplayFault::kGone},
};

bool read_event(ReplayFault fault, std::string_view& line, ReplayScript& script) noexcept
{
    std::int64_t frame = 0;
    if (script.event_count == ReplayScript::kMostEvents || !read_number(line, 0, kMostFrames, frame))
        return false;
    ReplayEvent event{fault, static_cast<std::uint32_t>(frame), std::nullopt};
    const bool lasts = fault == ReplayFault::kHang || fault == ReplayFault::kGone;
    if (const std::string_view cure = lasts ? next_word(line) : std::string_view{}; !cure.empty()) {
        if (cure == "restart" && fault == ReplayFault::kHang)
            event.cured_by = Shake::kRestart;
        else if (cure == "reopen")
            event.cured_by = Shake::kReopen;
        else if (cure == "port")
            event.cured_by = Shake::kPort;
        else
            return false;
    }
    script.events[static_cast<std::size_t>(script.event_count++)] = event;
    return true;
}

bool read_control(std::string_view& line, ReplayScript& script) noexcept
{
    const std::optional<ControlId> id = control_named(next_word(line));
    using Limits = std::numeric_limits<std::int32_t>;
    std::int64_t numbers[4] = {};
    if (!id || script.control_count == kControlCount)
        return false;
    for (std::int64_t& number : numbers)
        if (!read_number(line, Limits::min(), Limits::max(), number))
            return false;
    const auto [least, most, step, usual] = numbers;
    if (least > usual || usual > most || step < 1)
        return false;
    for (int i = 0; i < script.control_count; ++i)
        if (script.controls[static_cast<std::size_t>(i)].range.id == *id)
            return false;
    const std::string_view how = next_word(line);
    if (!how.empty() && how != "stuck")
        return false;
    const auto narrow = [](std::int64_t number) { return static_cast<std::int32_t>(number); };
    script.controls[static_cast<std::size_t>(script.control_count++)] = {
        {*id, narrow(least), narrow(most), narrow(step), narrow(usual)}, !how.empty()};
    return true;
}

bool read_line(std::string_view line, ReplayScript& script) noexcept
{
    line = line.substr(0, line.find('#'));
    const std::string_view word = next_word(line);
    std::int64_t number = 0;
    bool good = false;
    if (word.empty())
        return true;
    if (word == "rate") {
        good = read_number(line, 1, 240, number);
        script.interval_100ns = good ? static_cast<std::uint32_t>(10'000'000 / number) : 0;
    } else if (word == "skew_us") {
        good = read_number(line, -1'000'000, 1'000'000, script.skew_us);
    } else if (word == "dark") {
        good = read_number(line, 0, 1000, number);
        script.dark_frames = static_cast<std::uint32_t>(number);
    } else if (word == "full") {
        good = read_number(line, 0, 100, number);
        script.refused_starts = static_cast<std::uint32_t>(number);
    } else if (word == "control") {
        good = read_control(line, script);
    } else {
        for (const FaultWord& known : kFaults)
            if (word == known.word)
                good = read_event(known.fault, line, script);
    }
    return good && next_word(line).empty();
}

} // namespace

Result<ReplayScript> parse_replay_script(std::string_view text, const char* name) noexcept
{
    ReplayScript script;
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t length = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, length);
        text.remove_prefix(std::min(length + 1, text.size()));
        line = line.substr(0, line.find('#'));
        while (!line.empty()) {
            const std::size_t part = std::min(line.find(';'), line.size());
            if (!read_line(line.substr(0, part), script)) {
                DeviceText<60> shown;
                shown.assign(line.data(), part);
                return failure(Fault::kConfig,
                               "%s: line %d: '%s' is nothing that a replay can do; see drivers/README.md", name, number,
                               shown.text);
            }
            line.remove_prefix(std::min(part + 1, line.size()));
        }
    }
    return script;
}

} // namespace dicot
