#include "dicot/medium/disk_medium.h"

#include "folder_entries.h"
#include "folder_walk.h"

#include "dicot/os/shown_path.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace dicot {
namespace {

constexpr mode_t kFolderMode = 0755;
constexpr mode_t kFileMode = 0644;

Errno errno_unless(bool done) noexcept
{
    return done ? 0 : errno;
}

/// A signal is no reason to give up.
template <typename Call>
auto until_uninterrupted(Call&& call) noexcept
{
    auto result = call();
    while (result < 0 && errno == EINTR)
        result = call();
    return result;
}

class DiskMedium final : public Medium
{
public:
    explicit DiskMedium(Descriptor root) noexcept : root_(std::move(root)) {}

    Errno make_folder(const char* path) override
    {
        Place place;
        const Errno found = find(path, place);
        return found.ok() ? errno_unless(::mkdirat(place.folder.number(), place.name, kFolderMode) == 0) : found;
    }
    Errno rename(const char* from, const char* to) override;
    Errno remove_file(const char* path) override { return remove(path, 0); }
    Errno remove_folder(const char* path) override { return remove(path, AT_REMOVEDIR); }
    Errno kind_of(const char* path, EntryKind& kind) override;
    Errno list(const char* path, FunctionRef<bool(const MediumEntry&)> visit) override
    {
        return list_entries(root_.number(), path, visit);
    }
    Errno stamp(const char* path, FolderStamp& stamp) override;

    Errno create(const char* path, File& file) override;
    Errno append(const char* path, File& file, std::uint64_t& size_bytes) override
    {
        return open_file(path, O_WRONLY | O_APPEND, file, size_bytes);
    }
    Errno write(File file, std::span<const std::byte> bytes) override;
    Errno open(const char* path, File& file, std::uint64_t& size_bytes) override
    {
        return open_file(path, O_RDONLY, file, size_bytes);
    }
    Errno read(File file, std::span<std::byte> into, std::size_t& got) override;
    Errno read_at(File file, std::uint64_t offset, std::span<std::byte> into, std::size_t& got) override;
    Errno close(File file) override;

    Errno sync_all() override
    {
        return errno_unless(until_uninterrupted([&] { return ::syncfs(root_.number()); }) == 0);
    }
    Errno sync_folder(const char* path) override;
    Errno space(MediumSpace& space) override;
    Errno lock() override { return errno_unless(::flock(root_.number(), LOCK_EX | LOCK_NB) == 0); }
    void unlock() override { (void)::flock(root_.number(), LOCK_UN); }

private:
    static constexpr std::size_t kMostOpen = 8;

    Errno find(const char* path, Place& place) const noexcept { return find_place(root_.number(), path, place); }
    Errno remove(const char* path, int flags) const noexcept;
    Errno open_file(const char* path, int access, File& file, std::uint64_t& size_bytes);
    Errno keep(Descriptor opened, File& file) noexcept;
    int number_of(File file) const noexcept;

    Descriptor root_;
    std::array<Descriptor, kMostOpen> files_;
};

Errno DiskMedium::rename(const char* from, const char* to)
{
    Place old_place, new_place;
    if (const Errno error = find(from, old_place); !error.ok())
        return error;
    if (const Errno error = find(to, new_place); !error.ok())
        return error;
    const int old_folder = old_place.folder.number();
    const int new_folder = new_place.folder.number();
    if (::renameat2(old_folder, old_place.name, new_folder, new_place.name, RENAME_NOREPLACE) == 0)
        return {};
    if (errno != EINVAL && errno != ENOSYS)
        return errno;
    // A file system that cannot tell whether it would replace something is asked before: one writer at a time.
    EntryKind kind{};
    const Errno there = kind_at(new_folder, new_place.name, kind);
    if (there.number() != ENOENT)
        return there.ok() ? EEXIST : there.number();
    return errno_unless(::renameat(old_folder, old_place.name, new_folder, new_place.name) == 0);
}

Errno DiskMedium::remove(const char* path, int flags) const noexcept
{
    Place place;
    const Errno found = find(path, place);
    return found.ok() ? errno_unless(::unlinkat(place.folder.number(), place.name, flags) == 0) : found;
}

Errno DiskMedium::kind_of(const char* path, EntryKind& kind)
{
    if (*path == '\0') {
        kind = EntryKind::kFolder;
        return {};
    }
    Place place;
    const Errno found = find(path, place);
    return found.ok() ? kind_at(place.folder.number(), place.name, kind) : found;
}

Errno DiskMedium::stamp(const char* path, FolderStamp& stamp)
{
    struct stat what
    {
    };
    if (*path == '\0') {
        if (::fstat(root_.number(), &what) != 0)
            return errno;
    } else {
        Place place;
        if (const Errno error = find(path, place); !error.ok())
            return error;
        if (::fstatat(place.folder.number(), place.name, &what, AT_SYMLINK_NOFOLLOW) != 0)
            return errno;
    }
    if (!S_ISDIR(what.st_mode))
        return ENOTDIR;
    constexpr std::int64_t kSecondNs = 1'000'000'000;
    stamp.id = what.st_ino;
    stamp.changed_ns = std::int64_t{what.st_mtim.tv_sec} * kSecondNs + what.st_mtim.tv_nsec;
    stamp.links = what.st_nlink;
    return {};
}

Errno DiskMedium::keep(Descriptor opened, File& file) noexcept
{
    if (!opened.ok())
        return errno;
    for (std::size_t k = 0; k < files_.size(); ++k) {
        if (files_[k].ok())
            continue;
        files_[k] = std::move(opened);
        file = static_cast<File>(k);
        return {};
    }
    return EMFILE;
}

int DiskMedium::number_of(File file) const noexcept
{
    const auto k = static_cast<std::size_t>(file);
    return file >= 0 && k < files_.size() ? files_[k].number() : -1; // the system calls it EBADF
}

Errno DiskMedium::create(const char* path, File& file)
{
    Place place;
    if (const Errno error = find(path, place); !error.ok())
        return error;
    constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    return keep(Descriptor{::openat(place.folder.number(), place.name, kFlags, kFileMode)}, file);
}

Errno DiskMedium::write(File file, std::span<const std::byte> bytes)
{
    while (!bytes.empty()) {
        const ssize_t written =
            until_uninterrupted([&] { return ::write(number_of(file), bytes.data(), bytes.size()); });
        if (written <= 0)
            return written < 0 ? errno : EIO;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

Errno DiskMedium::open_file(const char* path, int access, File& file, std::uint64_t& size_bytes)
{
    Place place;
    if (const Errno error = find(path, place); !error.ok())
        return error;
    // Asked before it is opened: to open a device may already start something.
    EntryKind kind{};
    if (const Errno error = kind_at(place.folder.number(), place.name, kind); !error.ok())
        return error;
    if (kind != EntryKind::kFile)
        return kind == EntryKind::kFolder ? EISDIR : EINVAL;
    const int flags = access | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    Descriptor opened{::openat(place.folder.number(), place.name, flags)};
    struct stat what
    {
    };
    if (!opened.ok() || ::fstat(opened.number(), &what) != 0)
        return errno;
    size_bytes = static_cast<std::uint64_t>(what.st_size);
    return S_ISREG(what.st_mode) ? keep(std::move(opened), file) : EINVAL;
}

Errno DiskMedium::read(File file, std::span<std::byte> into, std::size_t& got)
{
    got = 0;
    while (got < into.size()) {
        const ssize_t more =
            until_uninterrupted([&] { return ::read(number_of(file), into.data() + got, into.size() - got); });
        if (more < 0)
            return errno;
        if (more == 0)
            break;
        got += static_cast<std::size_t>(more);
    }
    return {};
}

Errno DiskMedium::read_at(File file, std::uint64_t offset, std::span<std::byte> into, std::size_t& got)
{
    got = 0;
    while (got < into.size()) {
        const std::uint64_t at = offset + got;
        if (at > static_cast<std::uint64_t>(std::numeric_limits<off_t>::max()))
            break; // behind every end
        const ssize_t more = until_uninterrupted(
            [&] { return ::pread(number_of(file), into.data() + got, into.size() - got, static_cast<off_t>(at)); });
        if (more < 0)
            return errno;
        if (more == 0)
            break;
        got += static_cast<std::size_t>(more);
    }
    return {};
}

Errno DiskMedium::close(File file)
{
    if (number_of(file) < 0)
        return EBADF;
    // Linux lets the descriptor go whatever it answers.
    const int number = files_[static_cast<std::size_t>(file)].release();
    return errno_unless(::close(number) == 0 || errno == EINTR);
}

Errno DiskMedium::sync_folder(const char* path)
{
    Descriptor folder;
    if (const Errno error = open_folder(root_.number(), path, folder); !error.ok())
        return error;
    const bool synced = until_uninterrupted([&] { return ::fsync(folder.number()); }) == 0;
    return errno_unless(synced || errno == EINVAL); // some file systems know no such thing
}

Errno DiskMedium::space(MediumSpace& space)
{
    struct statvfs card
    {
    };
    if (::fstatvfs(root_.number(), &card) != 0)
        return errno;
    space.total_bytes = std::uint64_t{card.f_blocks} * card.f_frsize;
    space.free_bytes = std::uint64_t{card.f_bavail} * card.f_frsize;
    return {};
}

} // namespace

Result<std::unique_ptr<Medium>> open_disk_medium(const std::string& path)
{
    Descriptor root{::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
    if (!root.ok())
        return failure(Fault::kNoInput, "%s: cannot be opened as a folder (%s); check the path",
                       shown_path(path.c_str()), strerrordesc_np(errno));
    return std::unique_ptr<Medium>{std::make_unique<DiskMedium>(std::move(root))};
}

} // namespace dicot
