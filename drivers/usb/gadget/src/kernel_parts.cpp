#include "kernel_parts.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/statfs.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

namespace dicot::gadget_parts {
namespace {

constexpr unsigned long kFunctionFs = 0xa647361; // f_fs.c; linux/magic.h has it not

bool is_folder(const std::string& path)
{
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored);
}

/// A module whose hardware never answers is not waited for: false, and its process is told to end and left alone.
bool await_end(pid_t child, int& ended)
{
    constexpr int kLooks = 200;
    constexpr timespec kPause{0, 50'000'000};
    for (int look = 0; look < kLooks; ++look) {
        const pid_t gone = ::waitpid(child, &ended, WNOHANG);
        if (gone == child)
            return true;
        if (gone < 0 && errno != EINTR)
            return false;
        ::nanosleep(&kPause, nullptr);
    }
    (void)::kill(child, SIGKILL);
    (void)::waitpid(child, &ended, WNOHANG);
    return false;
}

/// Whether modprobe says that it is there now.
bool load_module(const char* name)
{
    char program[] = "modprobe";
    char quiet[] = "-q";
    std::string module = name;
    char* const words[] = {program, quiet, module.data(), nullptr};
    char path[] = "PATH=/usr/sbin:/usr/bin:/sbin:/bin";
    char* const environment[] = {path, nullptr};
    for (const char* where : {"/sbin/modprobe", "/usr/sbin/modprobe", "/bin/modprobe"}) {
        pid_t child = 0;
        if (::posix_spawn(&child, where, nullptr, nullptr, words, environment) != 0)
            continue;
        int ended = 0;
        return await_end(child, ended) && WIFEXITED(ended) && WEXITSTATUS(ended) == 0;
    }
    return false;
}

} // namespace

Status provide_configfs(const std::string& config)
{
    const std::string wanted = config + "/usb_gadget";
    if (is_folder(wanted))
        return {};
    if (::geteuid() != 0)
        return failure(Fault::kUnavailable, "%s is not there, and only root can load what makes it: run as root",
                       wanted.c_str());
    (void)load_module("configfs");
    if (!is_folder(config))
        return failure(Fault::kUnavailable, "%s is not there: this kernel has no configfs (CONFIG_CONFIGFS_FS)",
                       config.c_str());
    (void)load_module("libcomposite");
    if (!is_folder(wanted) && ::mount("configfs", config.c_str(), "configfs", 0, nullptr) != 0 && errno != EBUSY)
        return failure(Fault::kOsError, "%s: configfs cannot be mounted (%s)", config.c_str(), strerrordesc_np(errno));
    if (!is_folder(wanted))
        return failure(
            Fault::kUnavailable,
            "%s is not there: this kernel has no libcomposite (CONFIG_USB_LIBCOMPOSITE, CONFIG_USB_CONFIGFS)",
            wanted.c_str());
    return {};
}

Status own_folder(const std::string& path)
{
    const auto refused = [&path](const char* what, int why) {
        return failure(why == EACCES || why == EPERM ? Fault::kUnavailable : Fault::kOsError, "%s: %s (%s)",
                       path.c_str(), what, strerrordesc_np(why));
    };
    if (::mkdir(path.c_str(), 0755) != 0 && errno != EEXIST)
        return refused("cannot be made", errno);
    const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0)
        return refused("is no folder", errno);
    const bool ours = ::fchown(folder, ::geteuid(), ::getegid()) == 0 && ::fchmod(folder, 0755) == 0;
    const int why = errno;
    ::close(folder);
    return ours ? Status{} : refused("cannot be made this user's own", why);
}

bool is_functionfs(const std::string& folder)
{
    struct statfs told
    {
    };
    return ::statfs(folder.c_str(), &told) == 0 && static_cast<unsigned long>(told.f_type) == kFunctionFs;
}

Status mount_functionfs(const std::string& name, const std::string& folder, uid_t user, gid_t group)
{
    TRY(unmount_functionfs(folder));
    char options[128];
    std::snprintf(options, sizeof options, "uid=%u,gid=%u,rmode=0550,fmode=0660", static_cast<unsigned>(user),
                  static_cast<unsigned>(group));
    if (::mount(name.c_str(), folder.c_str(), "functionfs", MS_NOSUID | MS_NODEV | MS_NOEXEC, options) == 0)
        return {};
    return failure(errno == EPERM ? Fault::kUnavailable : Fault::kOsError, "%s: FunctionFS cannot be mounted (%s)",
                   folder.c_str(),
                   errno == ENODEV ? "this kernel has none: CONFIG_USB_CONFIGFS_F_FS" : strerrordesc_np(errno));
}

Status unmount_functionfs(const std::string& folder)
{
    for (int i = 0; i < 8 && is_functionfs(folder); ++i)
        if (::umount2(folder.c_str(), MNT_DETACH | UMOUNT_NOFOLLOW) != 0)
            return failure(errno == EPERM ? Fault::kUnavailable : Fault::kOsError, "%s: cannot be unmounted (%s)",
                           folder.c_str(), errno == EPERM ? "run as root" : strerrordesc_np(errno));
    return {};
}

} // namespace dicot::gadget_parts
