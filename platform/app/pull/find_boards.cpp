#include "find_boards.h"

#include "config/device_name.h"

#include "dicot/base/utc_time.h"
#include "dicot/store/snapshot_name.h"

#include <deque>
#include <unordered_set>

namespace dicot::app {
namespace {

struct Folder
{
    std::uint32_t handle = 0; ///< 0: the top of the storage
    std::size_t depth = 0;
    ShortText<255> name;
};

/// One storage, level by level.
class Walk
{
public:
    Walk(DeviceTalk& talk, std::uint32_t storage, std::size_t& walked) : talk_(talk), storage_(storage), walked_(walked)
    {
    }

    Status run(std::vector<BoardFolder>& into);

private:
    Status look_into(const Folder& folder, std::vector<BoardFolder>& into);
    Status holds_snapshots(std::uint32_t day, std::string_view name, bool& holds);

    DeviceTalk& talk_;
    std::uint32_t storage_;
    std::size_t& walked_;
    std::deque<Folder> ahead_;
    std::unordered_set<std::uint32_t> seen_; ///< a folder that stands in itself is looked into once
};

Status Walk::run(std::vector<BoardFolder>& into)
{
    ahead_.push_back({});
    while (!ahead_.empty() && walked_ < kMostWalked) {
        const Folder folder = ahead_.front();
        ahead_.pop_front();
        ++walked_;
        TRY(look_into(folder, into));
    }
    return {};
}

Status Walk::look_into(const Folder& folder, std::vector<BoardFolder>& into)
{
    std::vector<Folder> folders;
    Folder day;
    const Status listed = talk_.for_each_in(storage_, folder.handle, true, mtp::Initiator::kMostHandles,
                                            [&](std::uint32_t handle, const mtp::ObjectFacts& facts) {
                                                const std::string_view name = facts.name.view();
                                                const bool is_day = facts.folder && is_day_name(name);
                                                if (is_day && folder.handle != 0)
                                                    day = {handle, folder.depth + 1, facts.name};
                                                else if (facts.folder && !is_day && !name.starts_with('.') &&
                                                         folders.size() < kMostWalked)
                                                    folders.push_back({handle, folder.depth + 1, facts.name});
                                                return day.handle == 0;
                                            });
    if (listed.fault() == Fault::kNoInput)
        return {};
    TRY(listed);
    if (day.handle != 0 && is_device_name(folder.name.view())) {
        bool holds = false;
        TRY(holds_snapshots(day.handle, day.name.view(), holds));
        if (holds) {
            into.push_back({storage_, folder.handle, std::string{folder.name.view()}});
            return {};
        }
    }
    for (const Folder& below : folders)
        if (below.depth < kMostDepth && ahead_.size() < kMostWalked && seen_.insert(below.handle).second)
            ahead_.push_back(below);
    return {};
}

Status Walk::holds_snapshots(std::uint32_t day, std::string_view name, bool& holds)
{
    return snapshots_of_day(talk_, storage_, day, name, [&](const OfferedSnapshot&) {
        holds = true;
        return false;
    });
}

} // namespace

Status snapshots_of_day(DeviceTalk& talk, std::uint32_t storage, std::uint32_t day, std::string_view day_name,
                        FunctionRef<bool(const OfferedSnapshot&)> visit)
{
    return talk.for_each_in(storage, day, true, mtp::Initiator::kMostHandles,
                            [&](std::uint32_t handle, const mtp::ObjectFacts& facts) {
                                const auto name = parse_snapshot_name(facts.name.view());
                                if (!facts.folder || !name || utc_day(name->began_us).view() != day_name)
                                    return true;
                                OfferedSnapshot offer;
                                offer.sequence = name->sequence;
                                offer.began_us = name->began_us;
                                offer.handle = handle;
                                return visit(offer);
                            });
}

Status find_boards(DeviceTalk& talk, std::vector<BoardFolder>& into)
{
    std::vector<std::uint32_t> storages;
    TRY(talk.initiator().storages(storages));
    std::size_t walked = 0;
    for (const std::uint32_t storage : storages)
        TRY(Walk(talk, storage, walked).run(into));
    if (into.empty() && walked >= kMostWalked)
        return failure(Fault::kBadData, "%s: no board's folder is among the first %zu folders of the device",
                       talk.where().data(), kMostWalked);
    return {};
}

} // namespace dicot::app
