#include "tree_source.h"

#include "dicot/base/utc_time.h"
#include "dicot/store/snapshot_name.h"

#include <algorithm>

namespace dicot::app {
namespace {

constexpr int kMostSessions = 3; ///< that one call of the puller may cost

/// Handles belong to a session; where it is another one, the same things are found again by their names.
class TreeSource final : public PullSource
{
public:
    TreeSource(std::shared_ptr<DeviceTalk> talk, const BoardFolder& folder)
        : talk_(std::move(talk)), folder_(folder), session_(talk_->initiator().session())
    {
    }

    std::string_view device() const override { return folder_.device; }
    std::string_view serial() const override { return talk_->serial(); }
    std::string_view where() const override { return talk_->where(); }

    Status snapshots(std::int64_t first_sequence, FunctionRef<bool(const OfferedSnapshot&)> visit) override;
    Status files(const OfferedSnapshot& snapshot, FunctionRef<bool(const OfferedFile&)> visit) override;
    Result<std::size_t> read(const OfferedFile& file, std::uint64_t offset, std::span<std::byte> into) override;
    bool takes_marks() const override { return false; }
    Status mark(std::span<const Pulled>) override
    {
        return failure(Fault::kUsage, "%s: the device is none of dicot's, it takes no marks", talk_->where().data());
    }
    Status offer_time(std::int64_t) override
    {
        return failure(Fault::kUsage, "%s: the device is none of dicot's, it takes no time", talk_->where().data());
    }

private:
    Status in_one_session(FunctionRef<Status()> work);
    Status list(std::int64_t first_sequence, std::vector<OfferedSnapshot>& into);
    Status folder_of(const OfferedSnapshot& snapshot, std::uint32_t& handle);
    Status handle_of(const OfferedFile& file, std::uint32_t& handle);
    std::uint64_t with_session(std::uint64_t handle) const { return std::uint64_t{session_} << 32 | handle; }
    bool is_of_session(std::uint64_t handle) const { return handle >> 32 == session_; }

    std::shared_ptr<DeviceTalk> talk_;
    BoardFolder folder_;
    unsigned session_;
    OfferedSnapshot at_; ///< the one whose files were asked for last: a file is one of them
    OfferedFile found_;  ///< of at_, found again on this connection
};

struct Day
{
    std::uint32_t handle;
    ShortText<15> name;
};

Status TreeSource::in_one_session(FunctionRef<Status()> work)
{
    Status done;
    for (int round = 0; round < kMostSessions; ++round) {
        const unsigned now = talk_->initiator().session();
        done = now == session_ ? Status{} : find_folder(*talk_, folder_.storage, folder_.path, folder_.handle);
        if (done.ok()) {
            session_ = now;
            done = work();
        }
        if (done.fault() != Fault::kTryAgain || talk_->initiator().session() == now)
            return done;
    }
    return failure(Fault::kUnavailable, "%s; plug it in again", done.message());
}

Status TreeSource::list(std::int64_t first_sequence, std::vector<OfferedSnapshot>& into)
{
    into.clear();
    talk_->begin_question();
    std::vector<Day> days;
    TRY(talk_->for_each_in(folder_.storage, folder_.handle, true, mtp::Initiator::kMostHandles,
                           [&](std::uint32_t handle, const mtp::ObjectFacts& facts) {
                               if (facts.folder && is_day_name(facts.name.view()))
                                   days.push_back({handle, facts.name.view()});
                               return true;
                           }));
    for (const Day& day : days) {
        TRY(snapshots_of_day(*talk_, folder_.storage, day.handle, day.name.view(), [&](const OfferedSnapshot& offer) {
            if (offer.sequence >= first_sequence)
                into.push_back(offer);
            return into.size() <= DeviceTalk::kMostOffered;
        }));
        if (into.size() > DeviceTalk::kMostOffered)
            return failure(Fault::kBadData, "%s: the folder %s on the device shows more snapshots than a board has",
                           talk_->where().data(), folder_.device.c_str());
    }
    return {};
}

Status TreeSource::snapshots(std::int64_t first_sequence, FunctionRef<bool(const OfferedSnapshot&)> visit)
{
    std::vector<OfferedSnapshot> offers;
    TRY(in_one_session([&] { return list(first_sequence, offers); }));
    // The board's clock may have been wrong: a later day may have lower numbers.
    std::ranges::sort(offers, [](const OfferedSnapshot& a, const OfferedSnapshot& b) {
        return a.sequence != b.sequence ? a.sequence < b.sequence : a.began_us < b.began_us;
    });
    for (OfferedSnapshot& offer : offers) {
        offer.handle = with_session(offer.handle);
        if (!visit(offer))
            return {};
    }
    return {};
}

Status TreeSource::folder_of(const OfferedSnapshot& snapshot, std::uint32_t& handle)
{
    handle = static_cast<std::uint32_t>(snapshot.handle);
    if (is_of_session(snapshot.handle))
        return {};
    const auto name = snapshot_name({snapshot.sequence, snapshot.began_us});
    const std::string path = folder_.path + "/" + utc_day(snapshot.began_us).c_str() + "/" + name.c_str();
    return find_folder(*talk_, folder_.storage, path, handle);
}

Status TreeSource::files(const OfferedSnapshot& snapshot, FunctionRef<bool(const OfferedFile&)> visit)
{
    std::vector<OfferedFile> files;
    const auto look = [&]() -> Status {
        files.clear();
        std::uint32_t folder = 0;
        TRY(folder_of(snapshot, folder));
        return talk_->files_in(folder_.storage, folder, [&](const OfferedFile& file) {
            files.push_back(file);
            return true;
        });
    };
    TRY(in_one_session(look));
    at_ = snapshot;
    for (OfferedFile& file : files) {
        file.handle = with_session(file.handle);
        if (!visit(file))
            return {};
    }
    return {};
}

Status TreeSource::handle_of(const OfferedFile& file, std::uint32_t& handle)
{
    handle = static_cast<std::uint32_t>(file.handle);
    if (is_of_session(file.handle))
        return {};
    if (!is_of_session(found_.handle) || found_.name != file.name) {
        std::uint32_t folder = 0;
        TRY(folder_of(at_, folder));
        found_ = {};
        TRY(talk_->files_in(folder_.storage, folder, [&](const OfferedFile& one) {
            if (one.name == file.name)
                found_ = {one.name, one.bytes, with_session(one.handle)};
            return found_.handle == 0;
        }));
    }
    if (found_.handle == 0 || found_.bytes != file.bytes)
        return failure(Fault::kNoInput, "%s: the device does not show %s any more as it was", talk_->where().data(),
                       file.name.c_str());
    handle = static_cast<std::uint32_t>(found_.handle);
    return {};
}

Result<std::size_t> TreeSource::read(const OfferedFile& file, std::uint64_t offset, std::span<std::byte> into)
{
    std::size_t got = 0;
    const auto take = [&]() -> Status {
        std::uint32_t handle = 0;
        TRY(handle_of(file, handle));
        got = TRY(talk_->initiator().read(handle, file.bytes, offset, into));
        return {};
    };
    TRY(in_one_session(take));
    return got;
}

} // namespace

std::unique_ptr<PullSource> open_tree(std::shared_ptr<DeviceTalk> talk, const BoardFolder& folder)
{
    return std::make_unique<TreeSource>(std::move(talk), folder);
}

} // namespace dicot::app
