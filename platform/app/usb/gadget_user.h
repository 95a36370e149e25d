// Root prepares, somebody else serves.
#pragma once

#include "dicot/base/status.h"

#include <string>
#include <sys/types.h>

namespace dicot::app {

struct GadgetUser
{
    uid_t user = 0;
    gid_t group = 0;
};

/// Whoever the clouds belong to: he may read and mark them, and needs nothing else. Of a folder that is not there yet
/// the user dicot, or root where there is none.
GadgetUser user_for(const std::string& store);
/// From now on this process is that user, for good. Fault::kOsError.
Status become(const GadgetUser& user);

} // namespace dicot::app
