#include "find_boards.h"

#include "config/device_name.h"

#include "dicot/base/utc_time.h"
#include "dicot/store/snapshot_name.h"

#include <algorithm>
#include <deque>
#include <unordered_set>

namespace dicot::app {
namespace {

struct Folder
{
    std::uint32_t handle = 0; ///< 0: the top of the storage
    std::size_t depth = 0;
    std::string path; ///< names with '/' between them

    std::string_view name() const { return std::string_view{path}.substr(path.rfind('/') + 1); }
};

struct Day
{
    std::uint32_t handle = 0;
    ShortText<15> name;
};

std::string below(const std::string& path, std::string_view name)
{
    return path.empty() ? std::string{name} : path + "/" + std::string{name};
}

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
    Status hold_snapshots(const std::vector<Day>& days, bool& hold);

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
        const Folder folder = std::move(ahead_.front());
        ahead_.pop_front();
        ++walked_;
        TRY(look_into(folder, into));
    }
    return {};
}

Status Walk::look_into(const Folder& folder, std::vector<BoardFolder>& into)
{
    std::vector<Folder> folders;
    std::vector<Day> days;
    const auto sort_out = [&](std::uint32_t handle, const mtp::ObjectFacts& facts) {
        const std::string_view name = facts.name.view();
        if (!facts.folder || name.empty() || name[0] == '.' || name.find('/') != std::string_view::npos)
            return true;
        if (is_day_name(name))
            days.push_back({handle, name});
        else if (folders.size() < kMostWalked)
            folders.push_back({handle, folder.depth + 1, below(folder.path, name)});
        return true;
    };
    const Status listed = talk_.for_each_in(storage_, folder.handle, true, mtp::Initiator::kMostHandles, sort_out);
    if (listed.fault() == Fault::kNoInput)
        return {};
    TRY(listed);
    bool holds = false;
    if (is_device_name(folder.name()))
        TRY(hold_snapshots(days, holds));
    if (holds) {
        into.push_back({storage_, folder.handle, std::string{folder.name()}, folder.path});
        return {};
    }
    for (Folder& one : folders)
        if (one.depth < kMostDepth && ahead_.size() < kMostWalked && seen_.insert(one.handle).second)
            ahead_.push_back(std::move(one));
    return {};
}

Status Walk::hold_snapshots(const std::vector<Day>& days, bool& hold)
{
    for (const Day& day : days) {
        TRY(snapshots_of_day(talk_, storage_, day.handle, day.name.view(), [&](const OfferedSnapshot&) {
            hold = true;
            return false;
        }));
        if (hold)
            break;
    }
    return {};
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

Status find_folder(DeviceTalk& talk, std::uint32_t storage, std::string_view path, std::uint32_t& handle)
{
    handle = 0;
    while (!path.empty()) {
        const std::string_view name = path.substr(0, path.find('/'));
        path.remove_prefix(std::min(path.size(), name.size() + 1));
        std::uint32_t found = 0;
        TRY(talk.for_each_in(storage, handle, true, mtp::Initiator::kMostHandles,
                             [&](std::uint32_t one, const mtp::ObjectFacts& facts) {
                                 if (facts.folder && facts.name.view() == name)
                                     found = one;
                                 return found == 0;
                             }));
        if (found == 0)
            return failure(Fault::kNoInput, "%s: the device shows no folder %.*s any more", talk.where().data(),
                           static_cast<int>(name.size()), name.data());
        handle = found;
    }
    return {};
}

Status find_boards(DeviceTalk& talk, std::vector<BoardFolder>& into)
{
    into.clear();
    talk.begin_question();
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
