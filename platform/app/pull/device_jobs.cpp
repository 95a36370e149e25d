#include "pull_job.h"

namespace dicot::app {

Result<std::vector<PullJob>> jobs_of_devices(const std::string&)
{
    return failure(Fault::kUnavailable, "no device");
}

} // namespace dicot::app
