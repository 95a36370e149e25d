#include "output_folder.h"

#include <cerrno>
#include <cstring>
#include <sys/stat.h>

namespace dicot::app {

Status make_folder(const std::string& path)
{
    struct stat there
    {
    };
    if (::stat(path.c_str(), &there) == 0 && S_ISDIR(there.st_mode))
        return {};
    if (::mkdir(path.c_str(), 0777) != 0)
        return failure(Fault::kCannotCreate, "%s: cannot be created as a folder (%s): name another one", path.c_str(),
                       std::strerror(errno));
    return {};
}

} // namespace dicot::app
