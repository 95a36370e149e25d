#include "stop_request.h"

namespace dicot::app {
namespace {

constexpr std::array kHeard{SIGINT, SIGTERM, SIGHUP, SIGPIPE};

volatile sig_atomic_t asked_to_stop = 0;

void note(int) noexcept
{
    asked_to_stop = 1;
}

} // namespace

StopRequest::StopRequest() noexcept : before_{}
{
    asked_to_stop = 0;
    for (std::size_t i = 0; i < kSignals; ++i) {
        struct sigaction action
        {
        };
        sigemptyset(&action.sa_mask);
        action.sa_handler = kHeard[i] == SIGPIPE ? SIG_IGN : note;
        action.sa_flags = kHeard[i] == SIGPIPE ? 0 : static_cast<int>(SA_RESETHAND | SA_RESTART);
        (void)::sigaction(kHeard[i], &action, &before_[i]);
    }
}

StopRequest::~StopRequest()
{
    for (std::size_t i = 0; i < kSignals; ++i)
        (void)::sigaction(kHeard[i], &before_[i], nullptr);
}

bool StopRequest::asked() noexcept
{
    return asked_to_stop != 0;
}

} // namespace dicot::app
