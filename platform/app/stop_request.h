// Ctrl-C, SIGTERM and a terminal that is gone as a question that long work asks between two steps.
#pragma once

#include <array>
#include <cstddef>
#include <signal.h>

namespace dicot::app {

/// While one lives, SIGINT, SIGTERM and SIGHUP no longer end the program: asked() tells. A second one, of somebody who
/// lost patience, ends it as ever. A pipe that nobody reads any more is an error of writing, no signal. One at a time.
class StopRequest
{
public:
    StopRequest() noexcept;
    StopRequest(const StopRequest&) = delete;
    StopRequest& operator=(const StopRequest&) = delete;
    ~StopRequest();

    static bool asked() noexcept;

private:
    static constexpr std::size_t kSignals = 4;
    std::array<struct sigaction, kSignals> before_;
};

} // namespace dicot::app
