#include "crash_medium.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace dicot::test {

Errno CrashMedium::strike(Touch touch)
{
    const bool can = fault_.error == EIO ||
                     (fault_.error == EROFS && (touch == Touch::kGrow || touch == Touch::kChange)) ||
                     (fault_.error == ENOSPC && touch == Touch::kGrow);
    if (!can)
        return {};
    const int k = counted_++;
    if (k != fault_.at && !(fault_.lasts && k > fault_.at))
        return {};
    ++struck_;
    return fault_.error;
}

void CrashMedium::note(Change change)
{
    if (listing_ && !change.name.empty()) {
        std::fprintf(stderr, "%s changes while the card is listed\n", change.name.c_str());
        std::abort();
    }
    now_.apply(change);
    log_.push_back(std::move(change));
}

CrashMedium::Place CrashMedium::place_of(std::string_view path) const
{
    Place place;
    int at = CardState::kRoot;
    while (true) {
        const std::string_view part = path.substr(0, path.find('/'));
        if (part.empty() || part == "." || part == "..") {
            place.error = EINVAL;
            return place;
        }
        const CardNode& folder = now_.nodes[static_cast<std::size_t>(at)];
        if (!folder.folder) {
            place.error = ENOTDIR;
            return place;
        }
        const auto entry = folder.entries.find(part);
        const int found = entry == folder.entries.end() ? -1 : entry->second;
        if (part.size() == path.size()) {
            place.folder = at;
            place.node = found;
            place.name = part;
            return place;
        }
        if (found < 0) {
            place.error = ENOENT;
            return place;
        }
        at = found;
        path.remove_prefix(part.size() + 1);
    }
}

CrashMedium::Made CrashMedium::make(const char* path, bool folder)
{
    if (const Errno error = strike(Touch::kGrow); !error.ok())
        return {error};
    const Place place = place_of(path);
    if (!place.error.ok() || place.node >= 0)
        return {place.error.ok() ? EEXIST : place.error};
    if (folder && now_.used_bytes() >= capacity_)
        return {ENOSPC};
    Change change;
    change.kind = Change::Kind::kMake;
    change.node = static_cast<int>(now_.nodes.size());
    change.makes_folder = folder;
    change.folder = place.folder;
    change.name = place.name;
    const int made = change.node;
    note(std::move(change));
    return {{}, made};
}

Errno CrashMedium::rename(const char* from, const char* to)
{
    if (const Errno error = strike(Touch::kGrow); !error.ok())
        return error;
    const Place source = place_of(from);
    const Place target = place_of(to);
    if (!source.error.ok() || !target.error.ok())
        return source.error.ok() ? target.error : source.error;
    if (source.node < 0)
        return ENOENT;
    if (target.node >= 0)
        return EEXIST;
    if (std::string_view{to}.substr(0, std::string_view{from}.size() + 1) == std::string{from} + "/")
        return EINVAL;
    Change change;
    change.kind = Change::Kind::kRename;
    change.node = source.node;
    change.folder = source.folder;
    change.name = source.name;
    change.to_folder = target.folder;
    change.to_name = target.name;
    note(std::move(change));
    return {};
}

Errno CrashMedium::remove(const char* path, bool folder)
{
    if (const Errno error = strike(Touch::kChange); !error.ok())
        return error;
    const Place place = place_of(path);
    if (!place.error.ok() || place.node < 0)
        return place.error.ok() ? ENOENT : place.error;
    if (node(place.node).folder != folder)
        return folder ? ENOTDIR : EISDIR;
    if (!node(place.node).entries.empty())
        return ENOTEMPTY;
    Change change;
    change.kind = Change::Kind::kUnlink;
    change.node = place.node;
    change.folder = place.folder;
    change.name = place.name;
    note(std::move(change));
    return {};
}

Errno CrashMedium::kind_of(const char* path, EntryKind& kind)
{
    if (const Errno error = strike(Touch::kRead); !error.ok())
        return error;
    kind = EntryKind::kFolder;
    if (*path == '\0')
        return {};
    const Place place = place_of(path);
    if (!place.error.ok() || place.node < 0)
        return place.error.ok() ? ENOENT : place.error;
    kind = node(place.node).folder ? EntryKind::kFolder : EntryKind::kFile;
    return {};
}

Errno CrashMedium::list(const char* path, FunctionRef<bool(const MediumEntry&)> visit)
{
    if (const Errno error = strike(Touch::kRead); !error.ok())
        return error;
    const Place place = *path == '\0' ? Place{{}, -1, CardState::kRoot, {}} : place_of(path);
    if (!place.error.ok() || place.node < 0)
        return place.error.ok() ? ENOENT : place.error;
    const CardNode& folder = node(place.node);
    if (!folder.folder)
        return ENOTDIR;
    const bool outer = std::exchange(listing_, true);
    // Backwards, so that nobody counts on the order of the names.
    for (auto entry = folder.entries.rbegin(); entry != folder.entries.rend(); ++entry) {
        if (!visit({entry->first, node(entry->second).folder ? EntryKind::kFolder : EntryKind::kFile}))
            break;
    }
    listing_ = outer;
    return {};
}

Errno CrashMedium::stamp(const char* path, FolderStamp& stamp)
{
    if (const Errno error = strike(Touch::kRead); !error.ok())
        return error;
    const Place place = *path == '\0' ? Place{{}, -1, CardState::kRoot, {}} : place_of(path);
    if (!place.error.ok() || place.node < 0)
        return place.error.ok() ? ENOENT : place.error;
    if (!node(place.node).folder)
        return ENOTDIR;
    // Each change of the log is a tick of the card's clock.
    const auto names_it = [&](const Change& change) {
        return (change.folder == place.node || change.to_folder == place.node) && !change.name.empty();
    };
    const auto last = std::find_if(log_.rbegin(), log_.rend(), names_it);
    stamp = {static_cast<std::uint64_t>(place.node), log_.rend() - last, 0};
    return {};
}

Errno CrashMedium::keep(int number, File& file)
{
    for (std::size_t k = 0; k < files_.size(); ++k) {
        if (files_[k].node >= 0)
            continue;
        files_[k] = {number, 0};
        file = static_cast<File>(k);
        return {};
    }
    return EMFILE;
}

CrashMedium::OpenFile* CrashMedium::opened(File file)
{
    const auto k = static_cast<std::size_t>(file);
    return file >= 0 && k < files_.size() && files_[k].node >= 0 ? &files_[k] : nullptr;
}

Errno CrashMedium::create(const char* path, File& file)
{
    const Made made = make(path, false);
    return made.error.ok() ? keep(made.node, file) : made.error;
}

Errno CrashMedium::write(File file, std::span<const std::byte> bytes)
{
    const OpenFile* open_file = opened(file);
    return open_file == nullptr ? EBADF : write_at(open_file->node, size_of(open_file->node), bytes);
}

Errno CrashMedium::open(const char* path, File& file, std::uint64_t& size_bytes)
{
    if (const Errno error = strike(Touch::kRead); !error.ok())
        return error;
    const Place place = place_of(path);
    if (!place.error.ok() || place.node < 0)
        return place.error.ok() ? ENOENT : place.error;
    if (node(place.node).folder)
        return EISDIR;
    size_bytes = size_of(place.node);
    return keep(place.node, file);
}

Errno CrashMedium::read(File file, std::span<std::byte> into, std::size_t& got)
{
    OpenFile* open_file = opened(file);
    if (open_file == nullptr)
        return EBADF;
    const Errno error = read_node(open_file->node, open_file->at, into, got);
    open_file->at += got;
    return error;
}

Errno CrashMedium::read_at(File file, std::uint64_t offset, std::span<std::byte> into, std::size_t& got)
{
    const OpenFile* open_file = opened(file);
    return open_file == nullptr ? Errno{EBADF} : read_node(open_file->node, offset, into, got);
}

Errno CrashMedium::close(File file)
{
    OpenFile* open_file = opened(file);
    if (open_file == nullptr)
        return EBADF;
    open_file->node = -1;
    return {};
}

Errno CrashMedium::sync_folder(const char* path)
{
    if (const Errno error = strike(Touch::kSync); !error.ok())
        return error;
    const Place place = *path == '\0' ? Place{{}, -1, CardState::kRoot, {}} : place_of(path);
    if (!place.error.ok() || place.node < 0)
        return place.error.ok() ? ENOENT : place.error;
    if (!node(place.node).folder)
        return ENOTDIR;
    Change change;
    change.kind = Change::Kind::kSyncFolder;
    change.folder = place.node;
    note(std::move(change));
    return {};
}

Errno CrashMedium::sync_all()
{
    if (const Errno error = strike(Touch::kSync); !error.ok())
        return error;
    Change change;
    change.kind = Change::Kind::kSyncAll;
    note(std::move(change));
    return {};
}

Errno CrashMedium::space(MediumSpace& space)
{
    if (const Errno error = strike(Touch::kRead); !error.ok())
        return error;
    space.total_bytes = capacity_;
    space.free_bytes = capacity_ - std::min(capacity_, now_.used_bytes());
    return {};
}

} // namespace dicot::test
