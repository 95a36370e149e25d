// Ctrl-C and SIGTERM as a question that long work asks between two steps.
#pragma once

#include <signal.h>

namespace dicot::app {

/// While one lives, SIGINT and SIGTERM no longer end the program: asked() tells. One at a time. A second SIGINT, of
/// somebody who lost patience, ends it as ever.
class StopRequest
{
public:
    StopRequest() noexcept;
    StopRequest(const StopRequest&) = delete;
    StopRequest& operator=(const StopRequest&) = delete;
    ~StopRequest();

    static bool asked() noexcept;

private:
    struct sigaction interrupt_
    {
    };
    struct sigaction terminate_
    {
    };
};

} // namespace dicot::app
