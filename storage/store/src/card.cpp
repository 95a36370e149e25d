#include "card.h"

#include "dicot/os/shown_path.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

namespace dicot {

Status card_failure(Errno why, const char* path, const char* doing)
{
    const char* const shown = path[0] == '\0' ? "the store's folder" : shown_path(path);
    switch (why.number()) {
    case ENOSPC:
    case EDQUOT:
        return failure(Fault::kIoError, "%s: the card is full; pull snapshots and prune, or take a larger one", shown);
    case EROFS:
        return failure(Fault::kIoError,
                       "%s: the card is read-only, as a card becomes when it dies; check it, or replace it", shown);
    case EIO:
        return failure(Fault::kIoError, "%s: %s failed in the card itself; replace it soon", shown, doing);
    case EACCES:
    case EPERM:
        return failure(Fault::kIoError,
                       "%s: %s: no permission: it belongs to another user; start dicot as that one, or give it to this "
                       "one (chown)",
                       shown, doing);
    case EMFILE:
    case ENFILE:
        return failure(Fault::kIoError, "%s: %s: too many files are open; allow more (ulimit -n), or close some", shown,
                       doing);
    case ENOTDIR:
        return failure(Fault::kIoError, "%s: %s: a file stands where a folder should; take it away", shown, doing);
    case EFBIG:
        return failure(
            Fault::kIoError,
            "%s: %s: larger than a file may become here; allow more (ulimit -f), or take another file system", shown,
            doing);
    default:
        return failure(Fault::kIoError, "%s: %s failed (%s)", shown, doing, strerrordesc_np(why.number()));
    }
}

Status on_card(Errno outcome, const char* path, const char* doing)
{
    return outcome.ok() ? Status{} : card_failure(outcome, path, doing);
}

Status opened(Errno outcome, const char* path)
{
    switch (outcome.number()) {
    case ENOENT:
        return failure(Fault::kNoInput, "%s: it is not there", shown_path(path));
    case EINVAL:
    case EISDIR:
    case ELOOP:
    case ENOTDIR:
        return failure(Fault::kBadData, "%s: it is no file", shown_path(path));
    default:
        return on_card(outcome, path, "opening it");
    }
}

bool is_there(Medium& medium, const char* path)
{
    EntryKind kind{};
    return medium.kind_of(path, kind).ok();
}

bool is_archive(Medium& medium)
{
    return is_there(medium, kArchiveMark) || is_there(medium, kBoardFile) || is_there(medium, kLastPullFile);
}

CardFile::~CardFile()
{
    if (open_)
        (void)medium_.close(file_);
}

Status CardFile::create(const StorePath& path)
{
    path_ = path;
    TRY(on_card(medium_.create(path_.c_str(), file_), path_.c_str(), "making it"));
    open_ = true;
    return {};
}

Status CardFile::write(std::span<const std::byte> bytes) noexcept
{
    return on_card(medium_.write(file_, bytes), path_.c_str(), "writing");
}

Status CardFile::close()
{
    open_ = false;
    return on_card(medium_.close(file_), path_.c_str(), "closing it");
}

Status write_file(Medium& medium, const StorePath& path, std::span<const std::byte> bytes)
{
    CardFile file(medium);
    TRY(file.create(path));
    TRY(file.write(bytes));
    return file.close();
}

Status read_file(Medium& medium, const StorePath& path, std::uint64_t most_bytes, std::span<std::byte> chunk,
                 FunctionRef<void(std::span<const std::byte>)> take)
{
    Medium::File file = 0;
    std::uint64_t size = 0;
    TRY(opened(medium.open(path.c_str(), file, size), path.c_str()));
    Status status;
    if (size > most_bytes)
        status = failure(Fault::kBadData, "%s: it is larger than such a file can be", shown_path(path.c_str()));
    // Not beyond the size: somebody may be making it longer.
    for (std::uint64_t left = size; status.ok() && left > 0;) {
        std::size_t got = 0;
        const auto piece = chunk.first(static_cast<std::size_t>(std::min<std::uint64_t>(chunk.size(), left)));
        status = on_card(medium.read(file, piece, got), path.c_str(), "reading");
        if (status.ok() && got == 0)
            status = failure(Fault::kBadData, "%s: it ends too early", shown_path(path.c_str()));
        if (status.ok())
            take(chunk.first(got));
        left -= got;
    }
    const Status closed = on_card(medium.close(file), path.c_str(), "closing it");
    return status.ok() ? closed : status;
}

Result<std::span<const std::byte>> read_whole(Medium& medium, const StorePath& path, std::span<std::byte> into)
{
    std::size_t used = 0;
    // The pieces are read to where they stay: each time into the rest of `into`.
    Medium::File file = 0;
    std::uint64_t size = 0;
    TRY(opened(medium.open(path.c_str(), file, size), path.c_str()));
    Status status;
    if (size > into.size())
        status = failure(Fault::kBadData, "%s: it is larger than such a file can be", shown_path(path.c_str()));
    for (std::size_t got = 1; status.ok() && got > 0 && used < size; used += got)
        status = on_card(medium.read(file, into.subspan(used, static_cast<std::size_t>(size) - used), got),
                         path.c_str(), "reading");
    const Status closed = on_card(medium.close(file), path.c_str(), "closing it");
    TRY(status.ok() ? closed : status);
    return std::span<const std::byte>(into.first(used));
}

Status empty_folder(Medium& medium, const StorePath& folder)
{
    // One at a time: a folder is not to change while it is listed.
    for (;;) {
        StorePath next;
        bool is_ours = true;
        const Errno listed = medium.list(folder.c_str(), [&](const MediumEntry& entry) {
            next = join(folder.view(), entry.name);
            is_ours = entry.kind != EntryKind::kFolder && next.view().ends_with(entry.name); // a long name is cut
            return false;
        });
        TRY(on_card(listed, folder.c_str(), "listing it"));
        if (next.empty())
            return {};
        if (!is_ours)
            return failure(Fault::kBadData, "%s: dicot did not make it; take it away", shown_path(next.c_str()));
        TRY(on_card(medium.remove_file(next.c_str()), next.c_str(), "removing it"));
    }
}

Status make_folder(Medium& medium, const StorePath& path)
{
    const Errno made = medium.make_folder(path.c_str());
    return made.number() == EEXIST ? Status{} : on_card(made, path.c_str(), "making a folder");
}

} // namespace dicot
