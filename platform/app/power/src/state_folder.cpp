#include "dicot/power/state_folder.h"

#include "dicot/os/shown_path.h"

#include <cerrno>
#include <cstring>

#include <sys/stat.h>
#include <unistd.h>

namespace dicot::app {

Status open_state_folder(const char* path) noexcept
{
    struct stat what
    {
    };
    int error = ::mkdir(path, 0755) == 0 || errno == EEXIST ? 0 : errno;
    if (error == 0)
        error = ::stat(path, &what) != 0 ? errno : !S_ISDIR(what.st_mode) ? ENOTDIR : 0;
    if (error == 0)
        error = ::access(path, W_OK | X_OK) == 0 ? 0 : errno;
    if (error == 0)
        return {};
    return failure(Fault::kCannotCreate,
                   "%s: dicot run cannot keep its state there (%s); name a folder in run.state that it may write to",
                   shown_path(path), strerrordesc_np(error));
}

} // namespace dicot::app
