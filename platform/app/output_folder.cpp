#include "output_folder.h"

#include <cerrno>
#include <cstring>
#include <sys/stat.h>

namespace dicot::app {

Status make_folder(const std::string& path)
{
    if (::mkdir(path.c_str(), 0777) == 0)
        return {};
    const int error = errno;
    struct stat there
    {
    };
    if (::stat(path.c_str(), &there) == 0 &&
        S_ISDIR(there.st_mode)) // asked afterwards: another process may make it too
        return {};
    return failure(Fault::kCannotCreate, "%s: cannot be created as a folder (%s): %s", path.c_str(),
                   std::strerror(error), error == ENOENT ? "make the folder around it first" : "name another one");
}

} // namespace dicot::app
