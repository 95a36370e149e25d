#include "part_folder.h"

#include "output_folder.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>

namespace dicot::app {

namespace fs = std::filesystem;

namespace {

Status sync_folder(const std::string& path)
{
    const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool synced = folder >= 0 && ::fsync(folder) == 0;
    const int error = errno;
    if (folder >= 0)
        ::close(folder);
    return synced ? Status{} : failure(Fault::kIoError, "%s: %s", path.c_str(), std::strerror(error));
}

/// 0, or errno. A file system that cannot tell whether it would replace something is asked before.
int rename_to_new(const std::string& from, const std::string& to)
{
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0)
        return 0;
    if (errno != EINVAL && errno != ENOSYS)
        return errno;
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(to, ignored)))
        return EEXIST;
    return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

} // namespace

PartFolder::~PartFolder()
{
    std::error_code ignored;
    if (!part_.empty())
        fs::remove_all(part_, ignored);
}

Status PartFolder::open(const std::string& around, const std::string& name)
{
    TRY(make_folder(around));
    const std::string part = around + "/." + name + "." + std::to_string(::getpid()) + ".part";
    std::error_code error;
    fs::remove_all(part, error); // of an earlier process of this number
    if (!fs::create_directory(part, error))
        return failure(Fault::kCannotCreate, "%s: a folder cannot be made in it: %s", around.c_str(),
                       error.message().c_str());
    part_ = part;
    target_ = around + "/" + name;
    return {};
}

Status PartFolder::commit()
{
    constexpr int kMostNames = 1000;
    TRY(sync_folder(part_));
    const std::string name = target_;
    int error = EEXIST;
    for (int k = 2; error == EEXIST && k < kMostNames; ++k) {
        error = rename_to_new(part_, target_);
        if (error == EEXIST)
            target_ = name + "_" + std::to_string(k);
    }
    if (error != 0)
        return failure(Fault::kIoError, "%s: %s", name.c_str(), std::strerror(error));
    part_.clear();
    return sync_folder(fs::path(target_).parent_path());
}

} // namespace dicot::app
