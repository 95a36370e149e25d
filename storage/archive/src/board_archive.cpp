#include "dicot/pull_archive/board_archive.h"

#include "board_notes.h"
#include "digest.h"
#include "disk_words.h"
#include "part_folder.h"

#include "dicot/base/printable.h"
#include "dicot/base/utc_time.h"
#include "dicot/os/shown_path.h"
#include "dicot/store/store.h"

#include <algorithm>
#include <cerrno>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace dicot {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{64} << 10; ///< what a pulled cable costs at most

class DiskArchive final : public BoardArchive
{
public:
    DiskArchive(Medium& medium, ReadingDesk desk) : medium_(medium), desk_(std::move(desk)), piece_(kPieceBytes) {}
    ~DiskArchive() override { medium_.unlock(); }

    Status start(std::string_view serial);

    std::optional<std::int64_t> find(std::int64_t sequence) const override
    {
        const auto there = here_.find(sequence);
        return there == here_.end() ? std::nullopt : std::optional{there->second};
    }
    std::int64_t count() const override { return static_cast<std::int64_t>(here_.size()); }
    bool is_owed(std::int64_t sequence) const override { return owed_.contains(sequence); }
    Result<Taken> take(PullSource& source, const OfferedSnapshot& offered, bool verify,
                       FunctionRef<bool(std::uint64_t)> arrived) override;
    Status note(const LastPull& pull) override;

private:
    Status make_it_this_boards(std::string_view serial);
    Status find_owed();
    /// `damaged`: stands in its place until the new one is complete.
    Result<Taken> take_new(PullSource& source, const OfferedSnapshot& offered, const SnapshotName& name,
                           const SnapshotName* damaged, FunctionRef<bool(std::uint64_t)> arrived);
    Status settle(PartFolder& part, const SnapshotName& name, const SnapshotName* damaged);
    /// Who is to be told of it must be able to rely upon it: also if power goes now.
    Status make_last(const SnapshotName& there);
    /// None: what is in its place cannot be believed.
    Result<std::optional<Taken>> compare(PullSource& source, const OfferedSnapshot& offered, const SnapshotName& there,
                                         bool verify);
    Status put_aside(const SnapshotName& name);

    Medium& medium_;
    ReadingDesk desk_;
    std::vector<std::byte> piece_;
    bool serial_known_ = false;
    std::map<std::int64_t, std::int64_t> here_; ///< sequence -> when it began
    std::set<std::int64_t> owed_;
    bool synced_ = false; ///< whatever stood here before
};

/// What a failure of the source means for this snapshot; those that end the pull are returned as they are.
Result<Taken> judged(const Status& why)
{
    Taken taken;
    taken.why = why;
    switch (why.fault()) {
    case Fault::kUnavailable:
        return why;
    case Fault::kBadData:
        taken.how = Took::kDamaged;
        break;
    case Fault::kNoInput:
        taken.how = Took::kGone;
        break;
    default:
        taken.how = Took::kUnreadable;
        break;
    }
    return taken;
}

Status DiskArchive::start(std::string_view serial)
{
    if (is_there(medium_, Store::kCatalogueName))
        return failure(Fault::kUsage,
                       "this is a board's own store, or a copy of one, and no archive: name another folder; "
                       "dicot pull --from takes its snapshots there");
    const Errno made = medium_.make_folder(kIncoming);
    if (made.number() != EEXIST)
        TRY(on_disk(made, kIncoming, "making a folder"));
    TRY(mark_archive(medium_));
    TRY(make_it_this_boards(serial));
    const Result<bool> listed = for_each_folder(medium_, [&](const StorePath&, const SnapshotName& name) {
        here_.emplace(name.sequence, name.began_us);
        return true;
    });
    if (!listed.ok())
        return listed.status();
    if (!listed.value())
        return failure(Fault::kIoError,
                       "a day's folder cannot be listed: see what is wrong with this disk, then pull again");
    return find_owed();
}

Status DiskArchive::find_owed()
{
    const auto names_in = [&](const char* room, bool also_here) {
        const Errno listed = medium_.list(room, [&](const MediumEntry& entry) {
            // In quarantine/ ".2" may stand behind the name.
            const auto name = parse_snapshot_name(entry.name.substr(0, entry.name.find('.')));
            if (name && (also_here || !here_.contains(name->sequence)))
                owed_.insert(name->sequence);
            return true;
        });
        return listed.number() == ENOENT ? Status{} : on_disk(listed, room, "listing it");
    };
    TRY(names_in(kIncoming, true));
    return names_in(kQuarantine, false);
}

Status DiskArchive::make_it_this_boards(std::string_view serial)
{
    if (serial.empty())
        return {};
    const std::string known = TRY(read_board(medium_));
    serial_known_ = true;
    if (known == serial)
        return {};
    if (known.empty())
        return write_board(medium_, serial);
    return failure(Fault::kBadData,
                   "this folder is of the board with serial number %s, and this one has %s: give one of them another "
                   "name (output.device), or pull it alone (--device) into another archive",
                   printable<63>(known).c_str(), printable<63>(serial).c_str());
}

Result<Taken> DiskArchive::take(PullSource& source, const OfferedSnapshot& offered, bool verify,
                                FunctionRef<bool(std::uint64_t)> arrived)
{
    const Result<SnapshotName> name = name_of(offered);
    if (!name.ok())
        return judged(name.status());
    const bool must_hash = verify || is_owed(offered.sequence) || (!offered.pulled && source.takes_marks());
    const auto there = here_.find(offered.sequence);
    if (there == here_.end())
        return take_new(source, offered, name.value(), nullptr, arrived);
    const SnapshotName old{there->first, there->second};
    if (const auto compared = TRY(compare(source, offered, old, must_hash)))
        return *compared;
    return take_new(source, offered, name.value(), &old, arrived);
}

Status DiskArchive::make_last(const SnapshotName& there)
{
    if (!synced_)
        TRY(on_disk(medium_.sync_all(), "", "syncing"));
    synced_ = true;
    const StorePath day = utc_day(there.began_us).view();
    TRY(on_disk(medium_.sync_folder(day.c_str()), day.c_str(), "syncing"));
    if (owed_.erase(there.sequence) == 0)
        return {};
    return PartFolder(medium_, desk_, piece_, there).let_go();
}

Result<std::optional<Taken>> DiskArchive::compare(PullSource& source, const OfferedSnapshot& offered,
                                                  const SnapshotName& there, bool verify)
{
    const StorePath folder = folder_of(row_named(there));
    const Result<ReadSums> sums = read_sums(medium_, folder);
    std::optional<ShortText<64>> theirs;
    if (offered.sums)
        theirs = digest_text(*offered.sums);
    else if (verify) {
        const Result<Offer> offer = read_offer(source, offered);
        if (!offer.ok())
            return std::optional<Taken>{TRY(judged(offer.status()))};
        theirs = offer.value().sums_sha256;
    }
    const bool same_time = there.began_us == offered.began_us;
    const bool same = same_time && sums.ok() && (!theirs || sums.value().sha256 == *theirs);
    Taken taken;
    if (same && !verify) {
        taken.how = Took::kThere;
        taken.sums = digest_bytes(sums.value().sha256);
        return std::optional{taken};
    }
    // Whoever differs may be damaged.
    if (TRY(is_whole(medium_, folder, there, desk_))) {
        taken.how = same ? Took::kThere : Took::kConflict;
        taken.sums = digest_bytes(sums.value().sha256);
        if (same)
            TRY(make_last(there));
        else
            taken.why =
                failure(Fault::kBadData,
                        "%s: the source has another snapshot of this number; two boards of one name, or one that "
                        "began anew: pull it into another archive",
                        folder.c_str());
        return std::optional{taken};
    }
    return std::optional<Taken>{};
}

Status DiskArchive::put_aside(const SnapshotName& name)
{
    constexpr int kMostTries = 100;
    const StorePath folder = folder_of(row_named(name));
    const Errno made = medium_.make_folder(kQuarantine);
    if (made.number() != EEXIST)
        TRY(on_disk(made, kQuarantine, "making a folder"));
    const StorePath aside = join(kQuarantine, snapshot_name(name).view());
    StorePath free_name = aside;
    Errno moved = medium_.rename(folder.c_str(), free_name.c_str());
    for (int k = 2; moved.number() == EEXIST && k < kMostTries; ++k) {
        free_name = (std::string{aside.view()} + "." + std::to_string(k)).c_str();
        moved = medium_.rename(folder.c_str(), free_name.c_str());
    }
    TRY(on_disk(moved, folder.c_str(), "putting it aside"));
    here_.erase(name.sequence);
    return on_disk(medium_.sync_all(), kQuarantine, "syncing");
}

Result<Taken> DiskArchive::take_new(PullSource& source, const OfferedSnapshot& offered, const SnapshotName& name,
                                    const SnapshotName* damaged, FunctionRef<bool(std::uint64_t)> arrived)
{
    PartFolder part(medium_, desk_, piece_, name);
    if (damaged != nullptr)
        TRY(part.begin());
    const Result<Offer> offer = read_offer(source, offered);
    PartOutcome outcome{offer.status(), true};
    if (offer.ok())
        outcome = part.fill(source, offer.value(), arrived);
    if (!outcome.status.ok() && !outcome.by_source)
        return outcome.status;
    if (!outcome.status.ok()) {
        Taken taken = TRY(judged(outcome.status));
        taken.stays_damaged = damaged != nullptr;
        // Another source may end what this one cannot, unless only the board itself could.
        const bool in_vain = outcome.bytes_wrong || (taken.how == Took::kGone && serial_known_);
        if (in_vain && is_there(medium_, part.path().c_str()))
            TRY(part.let_go());
        return taken;
    }
    TRY(settle(part, name, damaged));
    Taken taken;
    if (damaged != nullptr)
        taken.put_aside = damaged->sequence;
    taken.how = Took::kNew;
    taken.sums = digest_bytes(offer.value().sums_sha256);
    taken.bytes = offer.value().bytes + offer.value().sums_text.size();
    return taken;
}

Status DiskArchive::settle(PartFolder& part, const SnapshotName& name, const SnapshotName* damaged)
{
    if (damaged != nullptr)
        TRY(put_aside(*damaged));
    TRY(part.settle());
    here_.emplace(name.sequence, name.began_us);
    owed_.erase(name.sequence);
    return {};
}

Status DiskArchive::note(const LastPull& pull)
{
    std::vector<SnapshotName> left;
    const Errno listed = medium_.list(kIncoming, [&](const MediumEntry& entry) {
        const auto name = parse_snapshot_name(entry.name);
        if (serial_known_ && name && !pull.had.has(name->sequence))
            left.push_back(*name);
        return true;
    });
    TRY(on_disk(listed, kIncoming, "listing it"));
    for (const SnapshotName& name : left)
        TRY(PartFolder(medium_, desk_, piece_, name).let_go());
    // A card or a copy knows only its own: what the board had stands.
    const auto before = serial_known_ ? std::nullopt : read_last_pull(medium_);
    return write_last_pull(medium_, before ? LastPull{pull.pulled_us, before->had.together(pull.had)} : pull);
}

} // namespace

Result<std::unique_ptr<BoardArchive>> BoardArchive::open(Medium& medium, std::string_view serial)
{
    const Errno locked = medium.lock();
    if (locked.number() == EWOULDBLOCK)
        return failure(Fault::kTryAgain, "another pull writes here; wait until it has finished");
    const int no_locks = locked.number(); // some file systems know none
    if (!locked.ok() && no_locks != EINVAL && no_locks != ENOLCK && no_locks != ENOTSUP && no_locks != ENOSYS)
        return on_disk(locked, "", "locking it");
    Result<ReadingDesk> desk = ReadingDesk::make();
    if (!desk.ok()) {
        medium.unlock();
        return desk.status();
    }
    auto archive = std::make_unique<DiskArchive>(medium, std::move(desk).value());
    TRY(archive->start(serial));
    return std::unique_ptr<BoardArchive>{std::move(archive)};
}

} // namespace dicot
