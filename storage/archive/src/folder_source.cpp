#include "dicot/pull_archive/folder_source.h"

#include "digest.h"

#include "card.h"
#include "snapshot_folder.h"

#include "dicot/store/snapshot_files.h"
#include "dicot/store/store.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

namespace dicot {
namespace {

class FolderSource final : public PullSource
{
public:
    FolderSource(std::unique_ptr<Medium> medium, std::string device, std::string where)
        : medium_(std::move(medium)), device_(std::move(device)), where_(std::move(where))
    {
    }

    ~FolderSource() override;

    std::string_view device() const override { return device_; }
    std::string_view serial() const override { return {}; }
    std::string_view where() const override { return where_; }
    Status snapshots(std::int64_t first_sequence, FunctionRef<bool(const OfferedSnapshot&)> visit) override;
    Status files(const OfferedSnapshot& snapshot, FunctionRef<bool(const OfferedFile&)> visit) override;
    Result<std::size_t> read(const OfferedFile& file, std::uint64_t offset, std::span<std::byte> into) override;
    Status mark(std::span<const Pulled>) override
    {
        return failure(Fault::kUsage, "a folder is only read; marks are for the board itself");
    }
    bool takes_marks() const override { return false; }
    Status offer_time(std::int64_t) override { return failure(Fault::kUsage, "a folder has no clock"); }

private:
    Status open_file(std::uint64_t handle);
    void close_file();

    std::unique_ptr<Medium> medium_;
    std::string device_, where_;
    SnapshotName at_;                   ///< the one whose files were asked for last: a handle means one of them
    SnapshotFiles files_;               ///< of it
    std::optional<std::uint64_t> open_; ///< handle of the file that is open
    Medium::File file_ = 0;
};

constexpr std::uint64_t kSumsHandle = Store::kMaxFiles;

FolderSource::~FolderSource()
{
    close_file();
}

void FolderSource::close_file()
{
    if (open_)
        (void)medium_->close(file_);
    open_.reset();
}

Status FolderSource::snapshots(std::int64_t first_sequence, FunctionRef<bool(const OfferedSnapshot&)> visit)
{
    std::vector<SnapshotName> names;
    const Result<bool> listed = for_each_folder(*medium_, [&](const StorePath&, const SnapshotName& name) {
        if (name.sequence >= first_sequence)
            names.push_back(name);
        return true;
    });
    TRY(listed.status());
    std::ranges::sort(names, [](const SnapshotName& a, const SnapshotName& b) {
        return a.sequence != b.sequence ? a.sequence < b.sequence : a.began_us < b.began_us;
    });
    for (const SnapshotName& name : names) {
        OfferedSnapshot offered{.sequence = name.sequence, .began_us = name.began_us, .bytes = {}, .sums = {}};
        // One that is damaged is offered too: so that it is named when it is taken.
        if (const auto files = files_of_snapshot(*medium_, folder_of(row_named(name)).c_str()); files.ok()) {
            offered.bytes = files.value().bytes();
            offered.sums = std::bit_cast<DigestBytes>(files.value().sums);
            offered.pulled = files.value().pulled;
        }
        if (!visit(offered))
            return {};
    }
    if (!listed.value())
        return failure(Fault::kIoError, "%s: a day's folder cannot be listed", where_.c_str());
    return {};
}

Status FolderSource::files(const OfferedSnapshot& snapshot, FunctionRef<bool(const OfferedFile&)> visit)
{
    close_file();
    at_ = {snapshot.sequence, snapshot.began_us};
    files_ = TRY(files_of_snapshot(*medium_, folder_of(row_named(at_)).c_str()));
    bool goes_on = visit({kSums, files_.sums_bytes, kSumsHandle});
    for (std::size_t k = 0; goes_on && k < files_.all().size(); ++k)
        goes_on = visit({files_.files[k].name, files_.files[k].bytes, k});
    return {};
}

Status FolderSource::open_file(std::uint64_t handle)
{
    if (open_ == handle)
        return {};
    close_file();
    const std::size_t k = static_cast<std::size_t>(handle);
    const StorePath path = join(folder_of(row_named(at_)).view(),
                                handle < files_.all().size() ? files_.files[k].name.view() : std::string_view{kSums});
    std::uint64_t size = 0;
    TRY(opened(medium_->open(path.c_str(), file_, size), path.c_str()));
    open_ = handle;
    return {};
}

Result<std::size_t> FolderSource::read(const OfferedFile& file, std::uint64_t offset, std::span<std::byte> into)
{
    TRY(open_file(file.handle));
    std::size_t got = 0;
    TRY(on_card(medium_->read_at(file_, offset, into, got), file.name.c_str(), "reading"));
    return got;
}

} // namespace

Result<std::unique_ptr<PullSource>> open_folder_source(std::unique_ptr<Medium> medium, std::string device,
                                                       std::string where)
{
    return std::unique_ptr<PullSource>{
        std::make_unique<FolderSource>(std::move(medium), std::move(device), std::move(where))};
}

} // namespace dicot
