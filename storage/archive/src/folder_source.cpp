#include "dicot/pull_archive/folder_source.h"

#include "digest.h"

#include "snapshot_folder.h"

#include <algorithm>
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
    Status offer_time(std::int64_t) override { return failure(Fault::kUsage, "a folder has no clock"); }

private:
    OfferedSnapshot offer(const SnapshotName& name);
    Status look_at_files(const StorePath& folder);
    StorePath path_of(std::uint64_t handle) const;

    std::unique_ptr<Medium> medium_;
    std::string device_, where_;
    SnapshotName at_;                 ///< the one whose files were asked for last
    std::vector<OfferedFile> files_;  ///< of it; a handle is an index
    std::optional<std::uint64_t> open_; ///< handle of the file that is open
    Medium::File file_ = 0;
    std::uint64_t offset_ = 0; ///< in it
};
