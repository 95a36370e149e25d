#include "dicot/os/output_file.h"

#include "dicot/os/shown_path.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dicot {
namespace {

Status cannot_create(const char* path, int error) noexcept
{
    const char* shown = shown_path(path);
    switch (error) {
    case ENOENT:
        return failure(Fault::kCannotCreate, "%s: its folder does not exist; make the folder first", shown);
    case ENOTDIR:
        return failure(Fault::kCannotCreate, "%s: a part of the path is a file and no folder; name another path",
                       shown);
    case EACCES:
    case EPERM:
        return failure(Fault::kCannotCreate, "%s: no permission to write there; name another folder", shown);
    case EROFS:
        return failure(Fault::kCannotCreate, "%s: the file system is read-only; name another folder", shown);
    case ENAMETOOLONG:
        return failure(Fault::kCannotCreate, "%s: the name is too long; name a shorter one", shown);
    case ENOSPC:
    case EDQUOT:
        return failure(Fault::kIoError, "%s: the disk is full; free some space", shown);
    default:
        return failure(Fault::kCannotCreate, "%s: cannot be created (%s); name another path", shown,
                       strerrordesc_np(error));
    }
}

/// Whether `path` is this process's own stream: opening it anew would start at the front of a redirected file.
int own_stream(const char* path) noexcept
{
    if (std::strcmp(path, "/dev/stdout") == 0)
        return STDOUT_FILENO;
    if (std::strcmp(path, "/dev/stderr") == 0)
        return STDERR_FILENO;
    return -1;
}

} // namespace

OutputFile::~OutputFile()
{
    abandon();
}

void OutputFile::abandon() noexcept
{
    if (descriptor_ >= 0)
        ::close(descriptor_);
    descriptor_ = -1;
    if (part_[0] != '\0')
        ::unlink(part_);
    part_[0] = '\0';
}

Status OutputFile::open(const char* path) noexcept
{
    abandon();
    buffered_ = 0;
    if (path[0] == '\0')
        return failure(Fault::kCannotCreate, "the output file has an empty name; name a file");
    const std::size_t length = std::strlen(path);
    if (length >= sizeof target_)
        return cannot_create(path, ENAMETOOLONG);
    std::memcpy(target_, path, length + 1);
    if (own_stream(path) >= 0)
        return open_direct(path);

    struct stat what
    {
    };
    if (::stat(path, &what) != 0) {
        if (errno != ENOENT)
            return cannot_create(path, errno);
        return open_part(false, 0666);
    }
    if (S_ISDIR(what.st_mode))
        return failure(Fault::kCannotCreate, "%s: is a folder; name a file in it", shown_path(path));
    if (S_ISBLK(what.st_mode))
        return failure(Fault::kCannotCreate, "%s: is a disk; name a file on it", shown_path(path));
    if (!S_ISREG(what.st_mode))
        return open_direct(path);
    if (::access(path, W_OK) != 0)
        return cannot_create(path, errno);
    if (::realpath(path, target_) == nullptr)
        return cannot_create(path, errno);
    return open_part(true, what.st_mode & 0777U);
}

Status OutputFile::open_direct(const char* path) noexcept
{
    direct_ = true;
    const int stream = own_stream(path);
    descriptor_ = stream >= 0 ? ::fcntl(stream, F_DUPFD_CLOEXEC, 3) : ::open(path, O_WRONLY | O_CLOEXEC);
    return descriptor_ < 0 ? cannot_create(path, errno) : Status{};
}

Status OutputFile::open_part(bool replaces, unsigned mode) noexcept
{
    direct_ = false;
    char part[PATH_MAX];
    const int length = std::snprintf(part, sizeof part, "%s.%ld.part", target_, static_cast<long>(::getpid()));
    if (length < 0 || static_cast<std::size_t>(length) >= sizeof part)
        return cannot_create(target_, ENAMETOOLONG);
    const int flags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW;
    descriptor_ = ::open(part, flags, static_cast<mode_t>(mode));
    if (descriptor_ < 0 && errno == EEXIST) {
        // Left by a process of the same number that lost its power.
        ::unlink(part);
        descriptor_ = ::open(part, flags, static_cast<mode_t>(mode));
    }
    if (descriptor_ < 0)
        return cannot_create(target_, errno);
    std::memcpy(part_, part, static_cast<std::size_t>(length) + 1);
    if (replaces)
        (void)::fchmod(descriptor_, static_cast<mode_t>(mode)); // undoes the umask; refused on FAT, which has no modes
    return {};
}

Status OutputFile::io_failure(int error) const noexcept
{
    const char* shown = shown_path(target_);
    if (error == ENOSPC)
        return failure(Fault::kIoError, "%s: the disk is full; free some space or write elsewhere", shown);
    if (error == EDQUOT)
        return failure(Fault::kIoError, "%s: the quota is used up; free some space or write elsewhere", shown);
    return failure(Fault::kIoError, "%s: writing failed (%s); check the disk or write elsewhere", shown,
                   strerrordesc_np(error));
}

Status OutputFile::write(const void* bytes, std::size_t count) noexcept
{
    return write({static_cast<const std::byte*>(bytes), count});
}

Status OutputFile::write(std::span<const std::byte> bytes) noexcept
{
    while (!bytes.empty()) {
        const std::size_t count = std::min(bytes.size(), kBufferBytes - buffered_);
        std::memcpy(buffer_ + buffered_, bytes.data(), count);
        buffered_ += count;
        bytes = bytes.subspan(count);
        if (buffered_ == kBufferBytes)
            TRY(flush());
    }
    return {};
}

Status OutputFile::flush() noexcept
{
    std::size_t written = 0;
    while (written < buffered_) {
        const ssize_t taken = ::write(descriptor_, buffer_ + written, buffered_ - written);
        if (taken >= 0)
            written += static_cast<std::size_t>(taken);
        else if (errno != EINTR) {
            const Status why = io_failure(errno);
            abandon(); // what was written is no beginning of anything: a commit() after this must fail
            return why;
        }
    }
    buffered_ = 0;
    return {};
}

Status OutputFile::sync() noexcept
{
    TRY(flush());
    return direct_ || ::fsync(descriptor_) == 0 ? Status{} : io_failure(errno);
}

Status OutputFile::commit() noexcept
{
    TRY(sync());
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0)
        return io_failure(errno);
    if (direct_)
        return {};
    if (::rename(part_, target_) != 0)
        return io_failure(errno);
    part_[0] = '\0';
    return sync_directory();
}

Status OutputFile::sync_directory() noexcept
{
    char folder[PATH_MAX] = ".";
    if (const char* const slash = std::strrchr(target_, '/'); slash != nullptr) {
        const auto length = static_cast<std::size_t>(slash == target_ ? 1 : slash - target_);
        std::memcpy(folder, target_, length);
        folder[length] = '\0';
    }
    const int descriptor = ::open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        return errno == EACCES ? Status{} : io_failure(errno); // a folder one may write to but not list
    const int error = ::fsync(descriptor) == 0 ? 0 : errno;
    ::close(descriptor);
    // Some file systems cannot sync a directory and say so with EINVAL.
    return error == 0 || error == EINVAL ? Status{} : io_failure(error);
}

} // namespace dicot
