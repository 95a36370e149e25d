#include "dicot/power/rest.h"

#include "dicot/os/input_file.h"
#include "dicot/os/output_file.h"
#include "dicot/os/small_file.h"
#include "dicot/power/rest_mark.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>

namespace dicot::app {
namespace {

constexpr std::int64_t kNearAlarmUs = 180'000'000; ///< a boot so near to the alarm is its work
constexpr std::int64_t kGraceUs = 600'000'000;     ///< for who switched the board on, or started the service, to log in
constexpr std::int64_t kVisitUs = 60'000'000;      ///< how often it is looked whether a computer is still there
constexpr std::int64_t kFreshBootUs = 180'000'000;

std::optional<RestMark> read_mark(const char* path) noexcept
{
    InputFile file;
    std::array<char, 256> bytes{};
    if (!file.open(path).ok())
        return std::nullopt;
    const Result<std::size_t> count = file.read(std::as_writable_bytes(std::span{bytes}));
    return count.ok() ? parse_rest_mark({bytes.data(), count.value()}) : std::nullopt;
}

} // namespace

const char* name_of(Between way) noexcept
{
    switch (way) {
    case Between::kSuspend:
        return "suspend";
    case Between::kOff:
        return "off";
    case Between::kIdle:
        break;
    }
    return "idle";
}

const char* name_of(WakeReason reason) noexcept
{
    switch (reason) {
    case WakeReason::kAlarm:
        return "alarm";
    case WakeReason::kOther:
        return "other";
    case WakeReason::kPowerOn:
        return "power on";
    case WakeReason::kClockChanged:
        return "clock changed";
    case WakeReason::kAsked:
        return "asked";
    case WakeReason::kTime:
        break;
    }
    return "time";
}

Rest::Rest(Board& board, LeadTime& lead, const RestRules& rules) noexcept
    : board_(board), lead_(lead), rules_(rules), mark_(JoinedPath{"%s/rest", rules.state.c_str()}.c_str())
{
}

void Rest::tell(const Status& why, Woken& woken) noexcept
{
    const ShortText<255> words{why.message()};
    if (why.ok() || words == told_)
        return;
    told_ = words;
    if (woken.trouble.empty())
        woken.trouble = words;
}

Status Rest::write_mark(std::uint64_t slot, std::int64_t due_us, std::int64_t alarm_us) noexcept
{
    const ShortText<200> words = text_of({slot, due_us, alarm_us, board_.boot()});
    OutputFile file;
    TRY(file.open(mark_.c_str()));
    TRY(file.write(words.c_str(), words.view().size()));
    return file.commit();
}

Woken Rest::begun() noexcept
{
    Woken woken;
    const std::optional<RestMark> mark = read_mark(mark_.c_str());
    const std::int64_t up_us = board_.boottime_us();
    const std::int64_t now_us = board_.now_us();
    awake_until_us_ = up_us + rules_.awake_first_us;
    const BootId boot = board_.boot();
    const bool same_boot = mark && std::string_view{mark->boot.text} == boot.text;
    if (same_boot || (!mark && up_us > kFreshBootUs)) {
        woken.reason = WakeReason::kOther;
    } else if (!mark || mark->alarm_us == 0) {
        woken.reason = WakeReason::kPowerOn;
    } else {
        woken.way = Between::kOff;
        const bool by_alarm = std::abs(now_us - up_us - mark->alarm_us) <= kNearAlarmUs;
        woken.reason = by_alarm ? WakeReason::kAlarm : WakeReason::kPowerOn;
        if (by_alarm)
            tell(lead_.note(LeadPart::kBoot, std::max<std::int64_t>(0, now_us - mark->alarm_us)), woken);
    }
    if (woken.reason != WakeReason::kAlarm)
        on_until_us_ = up_us + kGraceUs;
    if (!same_boot || mark->alarm_us != 0)
        tell(write_mark(0, 0, 0), woken);
    return woken;
}

std::int64_t Rest::begin_us(std::int64_t due_us) const noexcept
{
    return due_us - lead_.of(LeadPart::kCameras);
}

std::int64_t Rest::stays_on_until_us() noexcept
{
    if (rules_.between == Between::kIdle)
        return 0;
    const std::int64_t up_us = board_.boottime_us();
    const std::int64_t first_us = rules_.between == Between::kOff ? on_until_us_ : awake_until_us_;
    if (up_us < first_us)
        return first_us;
    return board_.computer_is_there() ? up_us + kVisitUs : 0;
}

Between Rest::way_to(std::int64_t due_us) noexcept
{
    const std::int64_t pause_us = begin_us(due_us) - board_.now_us();
    // Off: an alarm that rings while the board still shuts down is lost, and so is the series.
    const std::int64_t least_us = rules_.between == Between::kOff
                                      ? std::max(rules_.least_rest_us, 2 * lead_.of(LeadPart::kBoot))
                                      : rules_.least_rest_us + lead_.of(LeadPart::kResume);
    if (stays_on_until_us() != 0)
        return Between::kIdle;
    return pause_us >= least_us ? rules_.between : Between::kIdle;
}

Woken Rest::until(const RestWish& wish, FunctionRef<bool()> step) noexcept
{
    Woken woken;
    const std::int64_t on_until_us = stays_on_until_us();
    const std::int64_t on_us = on_until_us == 0 ? 0 : on_until_us - board_.boottime_us();
    if (on_us > 0 && board_.now_us() + on_us < begin_us(wish.due_us)) {
        idle(board_.now_us() + on_us, step, woken); // and then it is asked again
        return woken;
    }
    const Between way = way_to(wish.due_us);
    Next next = Next::kIdle;
    if (way == Between::kSuspend)
        next = suspend(begin_us(wish.due_us), step, woken);
    else if (way == Between::kOff)
        next = power_off(wish, step, woken);
    if (next == Next::kIdle)
        idle(begin_us(wish.due_us), step, woken);
    return woken;
}

void Rest::idle(std::int64_t until_us, FunctionRef<bool()> step, Woken& woken) noexcept
{
    const WaitEnd end = board_.wait_until(until_us, rules_.step_us, step);
    if (end == WaitEnd::kAsked)
        woken.reason = WakeReason::kAsked;
    else if (end == WaitEnd::kClockChanged)
        woken.reason = WakeReason::kClockChanged;
}

} // namespace dicot::app
