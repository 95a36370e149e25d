#include "dicot/store/snapshot_files.h"

#include "snapshot_folder.h"

#include "dicot/os/shown_path.h"

#include <cerrno>

namespace dicot {
namespace {

constexpr std::uint64_t kMostFileBytes = kMaxSlotBytes / (2 * kMaxSums);

Result<std::uint64_t> size_of(Medium& medium, const StorePath& path)
{
    Medium::File file = 0;
    std::uint64_t size = 0;
    TRY(opened(medium.open(path.c_str(), file, size), path.c_str()));
    TRY(on_card(medium.close(file), path.c_str(), "closing it"));
    if (size > kMostFileBytes)
        return failure(Fault::kBadData, "%s: it is larger than such a file can be", shown_path(path.c_str()));
    return size;
}

Result<SnapshotFiles> look(Medium& medium, const StorePath& folder)
{
    const ReadSums sums = TRY(read_sums(medium, folder));
    SnapshotFiles files;
    for (const Sum& sum : sums.sums.all()) {
        const std::uint64_t bytes = TRY(size_of(medium, join(folder.view(), sum.name.view())));
        files.files[static_cast<std::size_t>(files.count++)] = {sum.name, bytes};
    }
    files.sums_bytes = sums.bytes;
    files.sums = sums.digest;
    files.pulled = pulled_time(medium, folder, sums.sha256).has_value();
    return files;
}

} // namespace

std::uint64_t SnapshotFiles::bytes() const
{
    std::uint64_t sum = sums_bytes;
    for (const StoredFile& file : all())
        sum += file.bytes;
    return sum;
}

Result<SnapshotFiles> files_of_snapshot(Medium& medium, const char* folder)
{
    const StorePath path = folder;
    Result<SnapshotFiles> files = look(medium, path);
    if (files.ok() || !is_damage(files.status()))
        return files;
    // It may have been moved away between two looks: asked last, so that nobody takes that for damage.
    EntryKind kind{};
    const Errno there = medium.kind_of(folder, kind);
    if (there.number() == ENOENT || there.number() == ENOTDIR || (there.ok() && kind != EntryKind::kFolder))
        return failure(Fault::kNoInput, "%s: it is not there", shown_path(folder));
    TRY(on_card(there, folder, "looking for it"));
    return failure(Fault::kBadData, "%s", files.status().message());
}

} // namespace dicot
