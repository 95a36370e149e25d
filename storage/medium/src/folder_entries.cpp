#include "folder_entries.h"

#include "folder_walk.h"

#include <cerrno>
#include <cstddef>
#include <cstring>

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dicot {
namespace {

EntryKind kind_of_mode(mode_t mode) noexcept
{
    return S_ISREG(mode) ? EntryKind::kFile : S_ISDIR(mode) ? EntryKind::kFolder : EntryKind::kOther;
}

/// The names in `entries`, `size` bytes as getdents64() gives them. False: the visitor has seen enough.
bool visit_entries(int folder, const char* entries, std::size_t size, FunctionRef<bool(const MediumEntry&)> visit,
                   Errno& error)
{
    for (std::size_t at = 0; at < size;) {
        struct dirent64 entry
        {
        };
        std::memcpy(&entry, entries + at, offsetof(struct dirent64, d_name));
        const char* name = entries + at + offsetof(struct dirent64, d_name);
        at += entry.d_reclen;
        if (std::strcmp(name, ".") == 0 || std::strcmp(name, "..") == 0)
            continue;
        EntryKind kind = entry.d_type == DT_REG   ? EntryKind::kFile
                         : entry.d_type == DT_DIR ? EntryKind::kFolder
                                                  : EntryKind::kOther;
        if (entry.d_type == DT_UNKNOWN)
            error = kind_at(folder, name, kind);
        if (!error.ok() || !visit({name, kind}))
            return false;
    }
    return true;
}

} // namespace

Errno kind_at(int folder, const char* name, EntryKind& kind) noexcept
{
    struct stat what
    {
    };
    if (::fstatat(folder, name, &what, AT_SYMLINK_NOFOLLOW) != 0)
        return errno;
    kind = kind_of_mode(what.st_mode);
    return {};
}

Errno list_entries(int root, const char* path, FunctionRef<bool(const MediumEntry&)> visit)
{
    Descriptor folder;
    Errno error = open_folder(root, path, folder);
    // opendir() would take memory from the heap.
    char entries[4096];
    bool more = error.ok();
    while (more) {
        const ssize_t size = ::getdents64(folder.number(), entries, sizeof entries);
        if (size < 0)
            return errno;
        more = size > 0 && visit_entries(folder.number(), entries, static_cast<std::size_t>(size), visit, error);
    }
    return error;
}

} // namespace dicot
