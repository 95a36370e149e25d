#include "disk_words.h"

#include "dicot/os/shown_path.h"

#include <cerrno>
#include <cstring>

namespace dicot {
namespace {

constexpr std::uint64_t kSpareBytes = std::uint64_t{1} << 20; ///< folders, records, the file system's own
constexpr double kMiB = 1 << 20;

} // namespace

Status on_disk(Errno outcome, const char* path, const char* doing)
{
    if (outcome.ok())
        return {};
    const char* const shown = path[0] == '\0' ? "the board's folder" : shown_path(path);
    switch (outcome.number()) {
    case ENOSPC:
    case EDQUOT:
        return failure(Fault::kIoError,
                       "%s: this disk is full; make room, then pull again: what arrived stays, and it goes on there",
                       shown);
    case EROFS:
        return failure(Fault::kIoError, "%s: this disk is read-only; name a folder on another one", shown);
    case EACCES:
    case EPERM:
        return failure(Fault::kIoError, "%s: %s: no permission; name a folder of your own", shown, doing);
    case EFBIG:
        return failure(Fault::kIoError, "%s: larger than a file may become here (ulimit -f, or the file system)",
                       shown);
    case ENOTDIR:
        return failure(Fault::kIoError, "%s: a file stands where a folder should; take it away", shown);
    default:
        return failure(Fault::kIoError, "%s: %s failed (%s)", shown, doing, strerrordesc_np(outcome.number()));
    }
}

Status has_room(Medium& medium, std::uint64_t wanted_bytes)
{
    MediumSpace space;
    if (!medium.space(space).ok() || wanted_bytes + kSpareBytes <= space.free_bytes || space.total_bytes == 0)
        return {};
    return failure(
        Fault::kIoError,
        "this disk has %.1f MiB free, and the next snapshot takes %.1f MiB; make room, then pull again: what "
        "arrived stays",
        static_cast<double>(space.free_bytes) / kMiB, static_cast<double>(wanted_bytes) / kMiB);
}

} // namespace dicot
