#include "control_thread.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include <linux/usb/functionfs.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace dicot::gadget_parts {
namespace {

/// Ends a read that waits for a host's data; does nothing by itself.
constexpr int kInterrupt = SIGUSR1;
/// A reset is acknowledged when what was under way is thrown away, but no later: hosts wait some seconds at most.
constexpr std::chrono::milliseconds kMostFlush{1000};
constexpr std::chrono::milliseconds kPause{5};

void nothing(int) noexcept {}

} // namespace

Status ControlThread::start(int control, SharedCable& cable) noexcept
{
    control_ = control;
    cable_ = &cable;
    stop_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    struct sigaction action
    {
    };
    action.sa_handler = nothing;
    (void)::sigaction(kInterrupt, &action, nullptr);
    sigset_t all, before;
    sigfillset(&all);
    sigdelset(&all, kInterrupt);
    (void)::pthread_sigmask(SIG_SETMASK, &all, &before);
    const int why = stop_ < 0 ? errno : ::pthread_create(&thread_, nullptr, enter, this);
    (void)::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (why != 0)
        return failure(Fault::kOsError, "no thread for what the computer asks (%s)", strerrordesc_np(why));
    started_ = true;
    return {};
}

ControlThread::~ControlThread()
{
    if (started_) {
        const std::uint64_t one = 1;
        (void)!::write(stop_, &one, sizeof one);
        while (!ended_.load()) {
            (void)::pthread_kill(thread_, kInterrupt);
            const timespec pause{0, std::chrono::nanoseconds(kPause).count()};
            ::nanosleep(&pause, nullptr);
        }
        (void)::pthread_join(thread_, nullptr);
    }
    if (stop_ >= 0)
        ::close(stop_);
}

void* ControlThread::enter(void* self) noexcept
{
    auto* thread = static_cast<ControlThread*>(self);
    thread->run();
    thread->ended_.store(true);
    return nullptr;
}

void ControlThread::run() noexcept
{
    for (;;) {
        pollfd both[] = {{stop_, POLLIN, 0}, {control_, POLLIN, 0}};
        if (::poll(both, 2, -1) < 0 && errno != EINTR)
            return;
        if (both[0].revents != 0)
            return;
        if (both[1].revents != 0)
            read_event();
    }
}

void ControlThread::read_event() noexcept
{
    usb_functionfs_event event{};
    if (::read(control_, &event, sizeof event) != static_cast<ssize_t>(sizeof event))
        return; // EIDRM: a request that the host has taken back
    if (event.type == FUNCTIONFS_SETUP) {
        const usb_ctrlrequest& raw = event.u.setup;
        answer({raw.bRequestType, raw.bRequest, raw.wValue, raw.wIndex, raw.wLength});
        return;
    }
    constexpr std::pair<int, Ep0Event> kEvents[] = {
        {FUNCTIONFS_BIND, Ep0Event::kBind},       {FUNCTIONFS_UNBIND, Ep0Event::kUnbind},
        {FUNCTIONFS_ENABLE, Ep0Event::kEnable},   {FUNCTIONFS_DISABLE, Ep0Event::kDisable},
        {FUNCTIONFS_SUSPEND, Ep0Event::kSuspend}, {FUNCTIONFS_RESUME, Ep0Event::kResume},
    };
    for (const auto& [type, meaning] : kEvents) {
        if (type != event.type)
            continue;
        const std::lock_guard guard(cable_->lock);
        cable_->image.hear(meaning);
    }
    tell();
}

void ControlThread::tell() noexcept
{
    const std::uint64_t one = 1;
    (void)!::write(cable_->wake, &one, sizeof one);
}

void ControlThread::stall(const Setup& setup) noexcept
{
    // FunctionFS's way: the wrong direction is a stall.
    char nothing_at_all = 0;
    if ((setup.type & USB_DIR_IN) != 0)
        (void)!::read(control_, &nothing_at_all, 0);
    else
        (void)!::write(control_, &nothing_at_all, 0);
    ++cable_->counts.stalls;
}

void ControlThread::answer(const Setup& setup) noexcept
{
    Ep0Answer answer;
    {
        const std::lock_guard guard(cable_->lock);
        answer = cable_->image.asked(setup);
    }
    switch (answer.kind) {
    case Ep0Answer::Kind::kStall:
        stall(setup);
        return;
    case Ep0Answer::Kind::kSend:
        (void)!::write(control_, answer.data.data(), std::min<std::size_t>(answer.bytes, setup.length));
        return;
    case Ep0Answer::Kind::kTake:
        break;
    }
    if (answer.bytes == 0) {
        acknowledge_reset(setup);
        return;
    }
    std::byte data[sizeof answer.data];
    const ssize_t count = ::read(control_, data, answer.bytes);
    if (count < 0)
        return;
    {
        const std::lock_guard guard(cable_->lock);
        if (!cable_->image.taken(setup, std::span(data).first(static_cast<std::size_t>(count))))
            return;
    }
    ++cable_->counts.cancels;
    tell();
}

void ControlThread::acknowledge_reset(const Setup& setup) noexcept
{
    {
        const std::lock_guard guard(cable_->lock);
        (void)cable_->image.taken(setup, {});
    }
    ++cable_->counts.resets;
    tell();
    {
        std::unique_lock waiting(cable_->lock);
        (void)cable_->flushed.wait_for(waiting, kMostFlush, [&] { return !cable_->image.must_flush(); });
    }
    char nothing_at_all = 0;
    (void)!::read(control_, &nothing_at_all, 0);
}

} // namespace dicot::gadget_parts
