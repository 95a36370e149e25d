#include "folder_walk.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace dicot {
namespace {

/// The first part into `name`; what is behind it, with its '/', stays in `path`.
Errno take_part(std::string_view& path, char (&name)[NAME_MAX + 1]) noexcept
{
    const std::string_view part = path.substr(0, path.find('/'));
    if (part.empty() || part == "." || part == "..")
        return EINVAL;
    if (part.size() > NAME_MAX)
        return ENAMETOOLONG;
    *std::copy(part.begin(), part.end(), name) = '\0';
    path.remove_prefix(part.size());
    return {};
}

} // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept
{
    std::swap(number_, other.number_);
    return *this;
}

Descriptor::~Descriptor()
{
    const int error = errno; // of what went wrong while it was open
    if (ok())
        ::close(number_);
    errno = error;
}

int Descriptor::release() noexcept
{
    return std::exchange(number_, -1);
}

Errno find_place(int root, std::string_view path, Place& place) noexcept
{
    constexpr int kFlags = O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
    place.folder = Descriptor{::openat(root, ".", kFlags)};
    while (place.folder.ok()) {
        if (const Errno error = take_part(path, place.name); !error.ok())
            return error;
        if (path.empty())
            return {};
        path.remove_prefix(1);
        place.folder = Descriptor{::openat(place.folder.number(), place.name, kFlags)};
    }
    return errno;
}

Errno open_folder(int root, std::string_view path, Descriptor& folder) noexcept
{
    constexpr int kFlags = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
    if (path.empty()) {
        folder = Descriptor{::openat(root, ".", kFlags)};
    } else {
        Place place;
        if (const Errno error = find_place(root, path, place); !error.ok())
            return error;
        folder = Descriptor{::openat(place.folder.number(), place.name, kFlags)};
    }
    return folder.ok() ? 0 : errno;
}

} // namespace dicot
