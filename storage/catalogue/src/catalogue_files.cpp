#include "catalogue_files.h"

#include "dicot/os/shown_path.h"

#include <cerrno>
#include <string>
#include <sys/stat.h>

namespace dicot {
namespace {

enum class Found
{
    kNothing,
    kFile,
    kOther,
};

Found look(const std::string& path, const char* vfs)
{
    if (vfs != nullptr) { // such a way knows no links
        sqlite3_vfs* const way = sqlite3_vfs_find(vfs);
        int there = 0;
        const bool known = way != nullptr && way->xAccess(way, path.c_str(), SQLITE_ACCESS_EXISTS, &there) == SQLITE_OK;
        return known && there != 0 ? Found::kFile : Found::kNothing;
    }
    struct stat status = {};
    if (lstat(path.c_str(), &status) != 0)
        return errno == ENOENT || errno == ENOTDIR ? Found::kNothing : Found::kFile; // opening it will say why
    return S_ISREG(status.st_mode) ? Found::kFile : Found::kOther;
}

} // namespace

Result<bool> look_at_catalogue_files(const char* path, const char* vfs)
{
    const std::string name = path;
    for (const char* const suffix : {"", "-wal", "-shm", "-journal"}) {
        const Found found = look(name + suffix, vfs);
        if (found == Found::kOther || (found == Found::kFile && suffix == std::string{"-journal"}))
            return failure(Fault::kBadData,
                           "%s%s: nothing that dicot made: dicot verify --repair makes the catalogue again from the "
                           "folders",
                           shown_path(path), suffix);
    }
    return look(name, vfs) == Found::kFile;
}

} // namespace dicot
