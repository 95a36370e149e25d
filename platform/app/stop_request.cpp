#include "stop_request.h"

namespace dicot::app {
namespace {

volatile sig_atomic_t asked_to_stop = 0;

void note(int) noexcept
{
    asked_to_stop = 1;
}

} // namespace

StopRequest::StopRequest() noexcept
{
    asked_to_stop = 0;
    struct sigaction action
    {
    };
    action.sa_handler = note;
    sigemptyset(&action.sa_mask);
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    (void)::sigaction(SIGINT, &action, &interrupt_);
    (void)::sigaction(SIGTERM, &action, &terminate_);
}

StopRequest::~StopRequest()
{
    (void)::sigaction(SIGINT, &interrupt_, nullptr);
    (void)::sigaction(SIGTERM, &terminate_, nullptr);
}

bool StopRequest::asked() noexcept
{
    return asked_to_stop != 0;
}

} // namespace dicot::app
