#include "tree_source.h"

#include "dicot/store/snapshot_name.h"

#include <algorithm>

namespace dicot::app {
namespace {

class TreeSource final : public PullSource
{
public:
    TreeSource(std::shared_ptr<DeviceTalk> talk, const BoardFolder& folder) : talk_(std::move(talk)), folder_(folder) {}

    std::string_view device() const override { return folder_.device; }
    std::string_view serial() const override { return talk_->serial(); }
    std::string_view where() const override { return talk_->where(); }

    Status snapshots(std::int64_t first_sequence, FunctionRef<bool(const OfferedSnapshot&)> visit) override;
    Status files(const OfferedSnapshot& snapshot, FunctionRef<bool(const OfferedFile&)> visit) override
    {
        return talk_->files_in(folder_.storage, static_cast<std::uint32_t>(snapshot.handle), visit);
    }
    Result<std::size_t> read(const OfferedFile& file, std::uint64_t offset, std::span<std::byte> into) override
    {
        return talk_->initiator().read(static_cast<std::uint32_t>(file.handle), file.bytes, offset, into);
    }
    Status mark(std::span<const Pulled>) override
    {
        return failure(Fault::kUsage, "%s: the device is none of dicot's, it takes no marks", talk_->where().data());
    }
    Status offer_time(std::int64_t) override
    {
        return failure(Fault::kUsage, "%s: the device is none of dicot's, it takes no time", talk_->where().data());
    }

private:
    std::shared_ptr<DeviceTalk> talk_;
    BoardFolder folder_;
};

struct Day
{
    std::uint32_t handle;
    ShortText<15> name;
};

Status TreeSource::snapshots(std::int64_t first_sequence, FunctionRef<bool(const OfferedSnapshot&)> visit)
{
    talk_->begin_question();
    std::vector<Day> days;
    TRY(talk_->for_each_in(folder_.storage, folder_.handle, true, mtp::Initiator::kMostHandles,
                           [&](std::uint32_t handle, const mtp::ObjectFacts& facts) {
                               if (facts.folder && is_day_name(facts.name.view()))
                                   days.push_back({handle, facts.name.view()});
                               return true;
                           }));
    // The board's clock may have been wrong: a later day may have lower numbers.
    std::vector<OfferedSnapshot> offers;
    for (const Day& day : days) {
        TRY(snapshots_of_day(*talk_, folder_.storage, day.handle, day.name.view(), [&](const OfferedSnapshot& offer) {
            if (offer.sequence >= first_sequence)
                offers.push_back(offer);
            return offers.size() <= DeviceTalk::kMostOffered;
        }));
        if (offers.size() > DeviceTalk::kMostOffered)
            return failure(Fault::kBadData, "%s: the folder %s on the device shows more snapshots than a board has",
                           talk_->where().data(), folder_.device.c_str());
    }
    std::ranges::sort(offers, [](const OfferedSnapshot& a, const OfferedSnapshot& b) {
        return a.sequence != b.sequence ? a.sequence < b.sequence : a.began_us < b.began_us;
    });
    for (const OfferedSnapshot& offer : offers)
        if (!visit(offer))
            return {};
    return {};
}

} // namespace

std::unique_ptr<PullSource> open_tree(std::shared_ptr<DeviceTalk> talk, const BoardFolder& folder)
{
    return std::make_unique<TreeSource>(std::move(talk), folder);
}

} // namespace dicot::app
