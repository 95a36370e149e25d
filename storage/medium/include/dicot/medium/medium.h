// A card as the store sees it: few operations, each of which may fail, or be the last before the power goes.
#pragma once

#include "dicot/base/function_ref.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace dicot {

/// 0, or the errno of the operation that failed. As a Status it would have to name a path that it does not know.
class [[nodiscard]] Errno
{
public:
    constexpr Errno(int number = 0) noexcept : number_(number) {} // NOLINT(google-explicit-constructor)
    constexpr bool ok() const noexcept { return number_ == 0; }
    constexpr int number() const noexcept { return number_; }

private:
    int number_;
};

enum class EntryKind
{
    kFile,
    kFolder,
    kOther, ///< a link, a device, a pipe: nothing that the store ever makes
};

struct MediumEntry
{
    std::string_view name; ///< lives as long as the visit
    EntryKind kind;
};

struct MediumSpace
{
    std::uint64_t total_bytes = 0;
    std::uint64_t free_bytes = 0; ///< that this user may still write
};

/// Tells a folder from itself at another time: whether names came or went in it. Clocks are coarse, and are set: what
/// changes within two seconds may look the same.
struct FolderStamp
{
    std::uint64_t id = 0;        ///< of this folder, not of another one of its name
    std::int64_t changed_ns = 0; ///< by the system's clock
    std::uint64_t links = 0;     ///< on many file systems grows with the folders in it

    friend bool operator==(const FolderStamp&, const FolderStamp&) = default;
};

/// Paths begin at the medium's root, parts joined by '/', "" being the root itself; a part is never empty, "." or "..",
/// and no link is followed, so that nothing outside is reached: anything else is EINVAL, ELOOP or ENOTDIR. What is done
/// lasts only after a sync: sync_all() for everything so far, sync_folder() for the names in one folder. Not for
/// several threads at once. Nothing takes memory from the heap.
class Medium
{
public:
    using File = int;

    virtual ~Medium() = default;

    virtual Errno make_folder(const char* path) = 0; ///< EEXIST
    /// Never replaces anything: EEXIST.
    virtual Errno rename(const char* from, const char* to) = 0;
    virtual Errno remove_file(const char* path) = 0;
    virtual Errno remove_folder(const char* path) = 0;            ///< an empty one
    virtual Errno kind_of(const char* path, EntryKind& kind) = 0; ///< ENOENT
    /// In any order, without "." and "..", until `visit` returns false. Nothing may be changed meanwhile.
    virtual Errno list(const char* path, FunctionRef<bool(const MediumEntry&)> visit) = 0;
    /// Of a folder. FAT never changes that of its root.
    virtual Errno stamp(const char* path, FolderStamp& stamp) = 0;

    virtual Errno create(const char* path, File& file) = 0; ///< a new file for writing: EEXIST
    /// A file that is there, for writing behind its `size_bytes`; files alone. ENOENT
    virtual Errno append(const char* path, File& file, std::uint64_t& size_bytes) = 0;
    virtual Errno write(File file, std::span<const std::byte> bytes) = 0; ///< all of them, behind what is there
    virtual Errno open(const char* path, File& file, std::uint64_t& size_bytes) = 0; ///< for reading; files alone
    /// Fills `into` from where the last read ended; fewer bytes only at the end.
    virtual Errno read(File file, std::span<std::byte> into, std::size_t& got) = 0;
    /// The same from `offset` on; read() goes on where it was.
    virtual Errno read_at(File file, std::uint64_t offset, std::span<std::byte> into, std::size_t& got) = 0;
    virtual Errno close(File file) = 0;

    virtual Errno sync_all() = 0;
    virtual Errno sync_folder(const char* path) = 0;
    virtual Errno space(MediumSpace& space) = 0;
    /// One writer at a time, until unlock(): EWOULDBLOCK if another one has it.
    virtual Errno lock() = 0;
    virtual void unlock() = 0;
};

} // namespace dicot
