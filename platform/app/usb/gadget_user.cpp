#include "gadget_user.h"

#include <cerrno>
#include <cstring>

#include <grp.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dicot::app {

GadgetUser user_for(const std::string& store)
{
    struct stat told
    {
    };
    if (::stat(store.c_str(), &told) == 0)
        return {told.st_uid, told.st_gid};
    if (const passwd* entry = ::getpwnam("dicot"); entry != nullptr)
        return {entry->pw_uid, entry->pw_gid};
    return {};
}

Status become(const GadgetUser& user)
{
    if (user.user == 0 || ::geteuid() != 0)
        return {};
    if (::setgroups(1, &user.group) != 0 || ::setresgid(user.group, user.group, user.group) != 0 ||
        ::setresuid(user.user, user.user, user.user) != 0)
        return failure(Fault::kOsError, "this process cannot become user %u (%s)", static_cast<unsigned>(user.user),
                       strerrordesc_np(errno));
    (void)::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    return {};
}

} // namespace dicot::app
