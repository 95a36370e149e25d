#include "dicot/os/stage_watch.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <unistd.h>

namespace dicot {
namespace {

constexpr std::int64_t kFeedUs = 1'000'000;
constexpr std::int64_t kNever = INT64_MIN / 2;

std::atomic<StageWatch*> current{nullptr};

/// A sentence of pieces, for a signal's handler: no printf there.
class Sentence
{
public:
    void add(const char* text) noexcept
    {
        while (*text != '\0' && size_ < sizeof bytes_)
            bytes_[size_++] = *text++;
    }
    void add(std::int64_t number) noexcept
    {
        char digits[20];
        std::size_t first = sizeof digits;
        digits[--first] = '\0';
        do
            digits[--first] = static_cast<char>('0' + number % 10);
        while ((number /= 10) > 0 && first > 0);
        add(digits + first);
    }
    void say() const noexcept { (void)!::write(STDERR_FILENO, bytes_, size_); }

private:
    char bytes_[256];
    std::size_t size_ = 0;
};

} // namespace

StageWatch::~StageWatch()
{
    if (!open_)
        return;
    arm(0);
    current.store(nullptr);
    if (has_timer_) {
        (void)::timer_delete(timer_);
        (void)::sigaction(SIGRTMIN + 3, &before_, nullptr);
    }
    file_.write({});
    notice_.stopping();
    device_.let_go();
}

Status StageWatch::open(const StageWatchRules& rules) noexcept
{
    if (current.load() != nullptr)
        return failure(Fault::kSoftware, "a second watch of stages was opened");
    grace_us_ = rules.grace_us;
    for_journal_ = std::getenv("JOURNAL_STREAM") != nullptr; // NOLINT(concurrency-mt-unsafe): at the start
    if (*rules.stage_file != '\0')
        TRY(file_.open(rules.stage_file));
    TRY(notice_.open());

    struct sigaction action
    {
    };
    sigemptyset(&action.sa_mask);
    action.sa_handler = cut_off;
    sigevent event{};
    event.sigev_notify = SIGEV_SIGNAL;
    event.sigev_signo = SIGRTMIN + 3;
    if (::sigaction(SIGRTMIN + 3, &action, &before_) != 0 || ::timer_create(CLOCK_MONOTONIC, &event, &timer_) != 0)
        return failure(Fault::kOsError, "no timer for the bounds of the stages (%s)", strerrordesc_np(errno));
    has_timer_ = true;

    device_path_ = rules.device;
    device_timeout_s_ = rules.device_timeout_s;
    if (!device_path_.empty())
        device_trouble_ = device_.open(device_path_.c_str(), device_timeout_s_);
    fed_us_.store(kNever);
    open_ = true;
    current.store(this);
    leave();
    return {};
}

std::int64_t StageWatch::most_silence_us() const noexcept
{
    std::int64_t silence_us = 60'000'000;
    if (notice_.most_silence_us() > 0)
        silence_us = std::min(silence_us, notice_.most_silence_us() / 3);
    if (device_.held())
        silence_us = std::min(silence_us, std::int64_t{device_timeout_s_} * 1'000'000 / 3);
    return silence_us;
}

bool StageWatch::past_bound(std::int64_t now_us) const noexcept
{
    const std::int64_t bound_us = bound_us_.load(std::memory_order_relaxed);
    return bound_us > 0 && now_us - began_us_.load(std::memory_order_relaxed) > bound_us;
}

void StageWatch::arm(std::int64_t after_us) noexcept
{
    if (!has_timer_)
        return;
    itimerspec when{};
    when.it_value.tv_sec = static_cast<time_t>(after_us / 1'000'000);
    when.it_value.tv_nsec = static_cast<long>(after_us % 1'000'000) * 1000;
    (void)::timer_settime(timer_, 0, &when, nullptr);
}

void StageWatch::begin(const char* stage, std::int64_t bound_us) noexcept
{
    arm(0);
    if (past_bound(monotonic_us()))
        overran_ = what_overran();
    now_.stage = stage;
    now_.bound_us = bound_us;
    bound_us_.store(0);
    began_us_.store(monotonic_us());
    bound_us_.store(bound_us);
    file_.write(now_);
    if (bound_us > 0)
        arm(bound_us + grace_us_);
    feed(monotonic_us());
}

void StageWatch::feed(std::int64_t now_us) noexcept
{
    std::int64_t fed_us = fed_us_.load(std::memory_order_relaxed);
    if (now_us - fed_us < kFeedUs || !fed_us_.compare_exchange_strong(fed_us, now_us))
        return;
    file_.sign_of_life(now_us - began_us_.load(std::memory_order_relaxed));
    if (past_bound(now_us))
        return;
    notice_.alive();
    device_.kick();
}

void StageWatch::slot(std::uint64_t number, std::int64_t due_us) noexcept
{
    StageWatch* const watch = current.load();
    if (watch == nullptr)
        return;
    watch->now_.slot = number;
    watch->now_.due_us = due_us;
    watch->overran_ = {};
}

void StageWatch::enter(const char* stage, std::int64_t bound_us) noexcept
{
    if (StageWatch* const watch = current.load(); watch != nullptr)
        watch->begin(stage, bound_us);
}

void StageWatch::leave() noexcept
{
    enter("", 0);
}

void StageWatch::progress() noexcept
{
    if (StageWatch* const watch = current.load(std::memory_order_relaxed); watch != nullptr)
        watch->feed(monotonic_us());
}

bool StageWatch::overrun() noexcept
{
    const StageWatch* const watch = current.load(std::memory_order_relaxed);
    return watch != nullptr && watch->past_bound(monotonic_us());
}

ShortText<120> StageWatch::what_overran() noexcept
{
    const StageWatch* const watch = current.load();
    if (watch == nullptr)
        return {};
    const std::int64_t now_us = monotonic_us();
    if (!watch->past_bound(now_us))
        return watch->overran_;
    char words[121];
    std::snprintf(words, sizeof words, "stage %s is past its bound: %lld s of %lld s", watch->now_.stage.c_str(),
                  static_cast<long long>((now_us - watch->began_us_.load()) / 1'000'000),
                  static_cast<long long>(watch->now_.bound_us / 1'000'000));
    return words;
}

void StageWatch::before_sleep() noexcept
{
    if (StageWatch* const watch = current.load(); watch != nullptr)
        watch->device_.let_go();
}

void StageWatch::after_sleep() noexcept
{
    StageWatch* const watch = current.load();
    if (watch == nullptr)
        return;
    if (!watch->device_path_.empty() && watch->device_trouble_.ok())
        watch->device_trouble_ = watch->device_.open(watch->device_path_.c_str(), watch->device_timeout_s_);
    watch->fed_us_.store(kNever);
    watch->feed(monotonic_us());
}

void StageWatch::cut_off(int) noexcept
{
    StageWatch* const watch = current.load();
    if (watch == nullptr)
        return;
    const std::int64_t now_us = monotonic_us();
    const std::int64_t lasted_us = now_us - watch->began_us_.load();
    if (!watch->past_bound(now_us - watch->grace_us_))
        return; // a signal that was on its way when the stage ended
    watch->file_.cut_off(lasted_us);
    Sentence sentence;
    sentence.add(watch->for_journal_ ? "<2>dicot: stage " : "dicot: stage ");
    sentence.add(watch->now_.stage.c_str());
    sentence.add(" does not end: ");
    sentence.add(lasted_us / 1'000'000);
    sentence.add(" s, its bound is ");
    sentence.add(watch->now_.bound_us / 1'000'000);
    sentence.add(" s; the program ends itself, for its supervisor to start it again\n");
    sentence.say();
    ::_exit(static_cast<int>(Fault::kSoftware));
}

} // namespace dicot
