#include "dicot/os/input_file.h"

#include "dicot/os/shown_path.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dicot {
namespace {

Status cannot_open(const char* path, int error) noexcept
{
    const char* shown = shown_path(path);
    if (error == ENOENT || error == ENOTDIR)
        return failure(Fault::kNoInput, "%s: no such file; check the path", shown);
    if (error == EACCES || error == EPERM)
        return failure(Fault::kNoInput, "%s: no permission to read it; change its mode or run as its owner", shown);
    return failure(Fault::kNoInput, "%s: cannot be opened (%s); check the path", shown, strerrordesc_np(error));
}

} // namespace

InputFile::~InputFile()
{
    if (descriptor_ >= 0)
        ::close(descriptor_);
}

Status InputFile::open(const char* path) noexcept
{
    path_ = path;
    // Without O_NONBLOCK a pipe that nobody writes to would hold the open up for ever.
    descriptor_ = ::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0)
        return cannot_open(path, errno);
    struct stat what
    {
    };
    if (::fstat(descriptor_, &what) != 0)
        return cannot_open(path, errno);
    if (S_ISDIR(what.st_mode))
        return failure(Fault::kNoInput, "%s: is a folder; name a file in it", shown_path(path));
    if (!S_ISREG(what.st_mode))
        return failure(Fault::kNoInput, "%s: is a pipe or a device; save it to a file first", shown_path(path));
    size_bytes_ = static_cast<std::uint64_t>(what.st_size);
    return {};
}

Result<std::size_t> InputFile::read(std::span<std::byte> into) noexcept
{
    std::size_t filled = 0;
    while (filled < into.size()) {
        const ssize_t got = ::read(descriptor_, into.data() + filled, into.size() - filled);
        if (got == 0)
            break;
        if (got > 0)
            filled += static_cast<std::size_t>(got);
        else if (errno != EINTR)
            return failure(Fault::kIoError, "%s: reading failed (%s); check the disk or copy the file again",
                           shown_path(path_), strerrordesc_np(errno));
    }
    return filled;
}

} // namespace dicot
