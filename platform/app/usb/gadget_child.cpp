#include "gadget_child.h"

#include "../run/journal.h"

#include "dicot/os/clock.h"
#include "dicot/os/small_file.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>

#include <pthread.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dicot::app {
namespace {

constexpr int kLeastPauseS = 60, kMostPauseS = 3600;

std::vector<char*> pointers_to(std::vector<std::string>& words)
{
    std::vector<char*> pointers;
    for (std::string& word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

/// What systemd told us is not for the child.
bool is_ours_alone(std::string_view entry)
{
    for (const char* name : {"NOTIFY_SOCKET=", "WATCHDOG_", "LISTEN_", "DICOT_GADGET_PARENT="})
        if (entry.starts_with(name))
            return true;
    return false;
}

} // namespace

Status GadgetChild::start(std::vector<std::string> words, const char* program)
{
    words_ = std::move(words);
    for (char** entry = environ; *entry != nullptr; ++entry)
        if (!is_ours_alone(*entry))
            environment_.emplace_back(*entry);
    environment_.push_back(std::string(kParent) + "=" + std::to_string(::getpid()));
    word_pointers_ = pointers_to(words_);
    environment_pointers_ = pointers_to(environment_);
    sigset_t all, before;
    sigfillset(&all);
    (void)::pthread_sigmask(SIG_SETMASK, &all, &before);
    Status started;
    try {
        thread_ = std::thread([this, program] { look_after(program); });
    } catch (const std::system_error& why) {
        started = failure(Fault::kOsError, "no thread to look after 'dicot gadget up' (%s)", why.what());
    }
    (void)::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return started;
}

GadgetChild::~GadgetChild()
{
    if (!thread_.joinable())
        return;
    {
        std::unique_lock guard(lock_);
        stop_ = true;
        if (child_ > 0)
            (void)::kill(child_, SIGTERM);
        changed_.notify_all();
        if (!changed_.wait_for(guard, std::chrono::seconds(kMostEndS), [this] { return ended_; })) {
            if (child_ > 0)
                (void)::kill(child_, SIGKILL);
            abandoned_ = !changed_.wait_for(guard, std::chrono::seconds(5), [this] { return ended_; });
            changed_.notify_all();
        }
    }
    thread_.join();
}

int GadgetChild::run_once(const char* program)
{
    posix_spawnattr_t how;
    (void)::posix_spawnattr_init(&how);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    (void)::posix_spawnattr_setsigdefault(&how, &all);
    (void)::posix_spawnattr_setsigmask(&how, &none);
    (void)::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    pid_t child = 0;
    int why = 0;
    {
        const std::lock_guard guard(lock_);
        if (stop_)
            return 0;
        why = ::posix_spawn(&child, program, nullptr, &how, word_pointers_.data(), environment_pointers_.data());
        child_ = why == 0 ? child : 0;
    }
    (void)::posix_spawnattr_destroy(&how);
    if (why != 0) {
        journal(Priority::kWarning, "'dicot gadget up' cannot be started (%s)", strerrordesc_np(why));
        return -why;
    }
    siginfo_t told{};
    // Looked at, not waited for: the kernel may never let go of one that hangs in a driver. Its number is ours until it
    // is taken here: nobody is told to end in its place.
    std::unique_lock guard(lock_);
    while (!abandoned_) {
        const bool asked = ::waitid(P_PID, static_cast<id_t>(child), &told, WEXITED | WNOHANG) == 0;
        if ((asked && told.si_pid == child) || (!asked && errno != EINTR))
            break;
        (void)changed_.wait_for(guard, std::chrono::milliseconds(stop_ ? 50 : 1000));
    }
    child_ = 0;
    return told.si_code == CLD_EXITED ? told.si_status : 128 + told.si_status;
}

void GadgetChild::look_after(const char* program)
{
    int pause_s = kLeastPauseS;
    for (;;) {
        const std::int64_t began_us = monotonic_us();
        const int ended = run_once(program);
        const bool lasted = monotonic_us() - began_us > std::int64_t{kLeastPauseS} * 1'000'000;
        pause_s = lasted ? kLeastPauseS : pause_s;
        std::unique_lock guard(lock_);
        if (!stop_ && ended == 0)
            journal(Priority::kNotice, "no computer sees the clouds any more: 'dicot gadget up' was ended");
        if (!stop_ && ended != 0) {
            journal(Priority::kWarning, "no computer sees the clouds: 'dicot gadget up' ended with %d; again in %d s",
                    ended, pause_s);
            (void)changed_.wait_for(guard, std::chrono::seconds(pause_s), [this] { return stop_; });
            pause_s = std::min(2 * pause_s, kMostPauseS);
        }
        if (stop_ || ended == 0) {
            ended_ = true;
            changed_.notify_all();
            return;
        }
    }
}

void end_with_parent() noexcept
{
    const char* const parent = std::getenv(GadgetChild::kParent);
    if (parent == nullptr)
        return;
    (void)::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (std::strtol(parent, nullptr, 10) != ::getppid()) // it went before it could be watched
        (void)::raise(SIGTERM);
}

void live_with_parent() noexcept
{
    const char* const parent = std::getenv(GadgetChild::kParent);
    if (parent == nullptr)
        return;
    end_with_parent();
    constexpr int kGivesWay = 5;
    (void)::setpriority(PRIO_PROCESS, 0, kGivesWay);
    (void)write_line("/proc/self/oom_score_adj", "500");
}

} // namespace dicot::app
