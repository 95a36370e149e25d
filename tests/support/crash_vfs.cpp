#include "crash_vfs.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <sqlite3.h>

namespace dicot::test {
namespace {

constexpr int kSectorBytes = 4096;
constexpr int kLongestPath = 256;

/// What is behind an open file of SQLite's.
struct Link
{
    CrashMedium* medium;
    int node;
    bool syncs_folder; ///< a journal that is new: as SQLite does on Unix, its first sync makes its name last
    int lock = SQLITE_LOCK_NONE;
    std::string delete_on_close;
    std::vector<std::unique_ptr<char[]>> shared;
};

struct CrashFile
{
    sqlite3_file base;
    Link* link;
};

Link& link_of(sqlite3_file* file)
{
    Link* link = nullptr; // the struct begins with the base, as SQLite wants it
    std::memcpy(&link, reinterpret_cast<char*>(file) + offsetof(CrashFile, link), sizeof link);
    return *link;
}

int code_of(Errno error, int code)
{
    return error.ok() ? SQLITE_OK : error.number() == ENOSPC ? SQLITE_FULL : code;
}

int close_file(sqlite3_file* file)
{
    std::unique_ptr<Link> link{&link_of(file)};
    if (!link->delete_on_close.empty())
        (void)link->medium->remove_file(link->delete_on_close.c_str()).ok();
    return SQLITE_OK;
}

int read_file(sqlite3_file* file, void* into, int size, sqlite3_int64 offset)
{
    Link& link = link_of(file);
    const std::span<std::byte> wanted{static_cast<std::byte*>(into), static_cast<std::size_t>(size)};
    std::size_t got = 0;
    if (!link.medium->read_node(link.node, static_cast<std::uint64_t>(offset), wanted, got).ok())
        return SQLITE_IOERR_READ;
    if (got == wanted.size())
        return SQLITE_OK;
    std::memset(wanted.data() + got, 0, wanted.size() - got);
    return SQLITE_IOERR_SHORT_READ;
}

int write_file(sqlite3_file* file, const void* from, int size, sqlite3_int64 offset)
{
    Link& link = link_of(file);
    const std::span<const std::byte> bytes{static_cast<const std::byte*>(from), static_cast<std::size_t>(size)};
    return code_of(link.medium->write_at(link.node, static_cast<std::uint64_t>(offset), bytes), SQLITE_IOERR_WRITE);
}

int truncate_file(sqlite3_file* file, sqlite3_int64 size)
{
    Link& link = link_of(file);
    return code_of(link.medium->truncate(link.node, static_cast<std::uint64_t>(size)), SQLITE_IOERR_TRUNCATE);
}

int sync_file(sqlite3_file* file, int)
{
    Link& link = link_of(file);
    if (!link.medium->sync_file(link.node).ok())
        return SQLITE_IOERR_FSYNC;
    if (!link.syncs_folder)
        return SQLITE_OK;
    link.syncs_folder = false;
    return code_of(link.medium->sync_folder(""), SQLITE_IOERR_DIR_FSYNC);
}

int file_size(sqlite3_file* file, sqlite3_int64* size)
{
    Link& link = link_of(file);
    *size = static_cast<sqlite3_int64>(link.medium->size_of(link.node));
    return SQLITE_OK;
}

int lock_file(sqlite3_file* file, int level)
{
    link_of(file).lock = level;
    return SQLITE_OK;
}

int check_reserved(sqlite3_file* file, int* reserved)
{
    *reserved = link_of(file).lock >= SQLITE_LOCK_RESERVED ? 1 : 0;
    return SQLITE_OK;
}

int map_shared(sqlite3_file* file, int region, int bytes, int extend, void volatile** memory)
{
    auto& shared = link_of(file).shared;
    const auto k = static_cast<std::size_t>(region);
    while (extend != 0 && shared.size() <= k)
        shared.push_back(std::make_unique<char[]>(static_cast<std::size_t>(bytes)));
    *memory = k < shared.size() ? shared[k].get() : nullptr;
    return SQLITE_OK;
}

const sqlite3_io_methods kMethods = {
    .iVersion = 2,
    .xClose = close_file,
    .xRead = read_file,
    .xWrite = write_file,
    .xTruncate = truncate_file,
    .xSync = sync_file,
    .xFileSize = file_size,
    .xLock = lock_file,
    .xUnlock = lock_file,
    .xCheckReservedLock = check_reserved,
    .xFileControl = [](sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; },
    .xSectorSize = [](sqlite3_file*) { return kSectorBytes; },
    .xDeviceCharacteristics = [](sqlite3_file*) { return SQLITE_IOCAP_POWERSAFE_OVERWRITE; },
    .xShmMap = map_shared,
    .xShmLock = [](sqlite3_file*, int, int, int) { return SQLITE_OK; },
    .xShmBarrier = [](sqlite3_file*) {},
    .xShmUnmap =
        [](sqlite3_file* file, int) {
            link_of(file).shared.clear();
            return SQLITE_OK;
        },
    .xFetch = nullptr,
    .xUnfetch = nullptr,
};

CrashMedium& medium_of(sqlite3_vfs* vfs)
{
    return *static_cast<CrashMedium*>(vfs->pAppData);
}

int open_file(sqlite3_vfs* vfs, const char* path, sqlite3_file* file, int flags, int* flags_out)
{
    file->pMethods = nullptr;
    CrashMedium& medium = medium_of(vfs);
    const bool nameless = path == nullptr;
    const std::string name = nameless ? "sqlite-temporary" : path;
    int node = medium.find_file(name.c_str());
    const bool makes = node < 0 && (flags & SQLITE_OPEN_CREATE) != 0;
    if (makes)
        node = medium.make(name.c_str(), false).node;
    if (node < 0)
        return SQLITE_CANTOPEN;
    if (flags_out != nullptr) {
        *flags_out = flags;
        if (medium.is_read_only() && (flags & SQLITE_OPEN_READWRITE) != 0)
            *flags_out = (flags & ~SQLITE_OPEN_READWRITE) | SQLITE_OPEN_READONLY;
    }
    constexpr int kJournals = SQLITE_OPEN_WAL | SQLITE_OPEN_MAIN_JOURNAL | SQLITE_OPEN_SUPER_JOURNAL;
    auto link = std::make_unique<Link>();
    link->medium = &medium;
    link->node = node;
    link->syncs_folder = makes && (flags & kJournals) != 0;
    if (nameless || (flags & SQLITE_OPEN_DELETEONCLOSE) != 0)
        link->delete_on_close = name;
    file->pMethods = &kMethods;
    Link* held = link.release();
    std::memcpy(reinterpret_cast<char*>(file) + offsetof(CrashFile, link), &held, sizeof held);
    return SQLITE_OK;
}

int delete_file(sqlite3_vfs* vfs, const char* path, int sync_folder)
{
    CrashMedium& medium = medium_of(vfs);
    const Errno removed = medium.remove_file(path);
    if (removed.number() == ENOENT)
        return SQLITE_IOERR_DELETE_NOENT;
    if (!removed.ok())
        return SQLITE_IOERR_DELETE;
    return sync_folder == 0 || medium.sync_folder("").ok() ? SQLITE_OK : SQLITE_IOERR_DIR_FSYNC;
}

int access_file(sqlite3_vfs* vfs, const char* path, int flags, int* answer)
{
    CrashMedium& medium = medium_of(vfs);
    const int node = medium.find_file(path);
    // As on Unix: an empty file does not count as being there.
    *answer = node >= 0 && (flags != SQLITE_ACCESS_EXISTS || medium.size_of(node) != 0) &&
              (flags != SQLITE_ACCESS_READWRITE || !medium.is_read_only());
    return SQLITE_OK;
}

int full_path(sqlite3_vfs*, const char* path, int size, char* full)
{
    return std::snprintf(full, static_cast<std::size_t>(size), "%s", path) < size ? SQLITE_OK : SQLITE_CANTOPEN;
}

sqlite3_vfs& the_vfs()
{
    static sqlite3_vfs vfs = {
        .iVersion = 1,
        .szOsFile = sizeof(CrashFile),
        .mxPathname = kLongestPath,
        .pNext = nullptr,
        .zName = CrashVfs::kName,
        .pAppData = nullptr,
        .xOpen = open_file,
        .xDelete = delete_file,
        .xAccess = access_file,
        .xFullPathname = full_path,
        .xDlOpen = nullptr,
        .xDlError = nullptr,
        .xDlSym = nullptr,
        .xDlClose = nullptr,
        .xRandomness =
            [](sqlite3_vfs*, int size, char* bytes) {
                std::memset(bytes, 1, static_cast<std::size_t>(size));
                return size;
            },
        .xSleep = [](sqlite3_vfs*, int microseconds) { return microseconds; },
        .xCurrentTime =
            [](sqlite3_vfs*, double* day) {
                *day = 2461193.0; // 2026-06-01
                return SQLITE_OK;
            },
        .xGetLastError = [](sqlite3_vfs*, int, char*) { return 0; },
        .xCurrentTimeInt64 = nullptr,
        .xSetSystemCall = nullptr,
        .xGetSystemCall = nullptr,
        .xNextSystemCall = nullptr,
    };
    return vfs;
}

} // namespace

CrashVfs::CrashVfs()
{
    if (sqlite3_vfs_register(&the_vfs(), 0) != SQLITE_OK)
        throw std::runtime_error("SQLite takes no other way to the disk");
}

CrashVfs::~CrashVfs()
{
    sqlite3_vfs_unregister(&the_vfs());
}

void CrashVfs::use(CrashMedium& medium)
{
    the_vfs().pAppData = &medium;
    sqlite3_test_control(SQLITE_TESTCTRL_PRNG_SEED, 1, nullptr); // the same run, the same bytes
}

} // namespace dicot::test
