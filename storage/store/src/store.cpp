#include "dicot/store/store.h"

#include "card.h"
#include "incoming.h"
#include "leaving.h"
#include "pulls.h"
#include "snapshot_folder.h"
#include "start_up.h"
#include "verify.h"
#include "writing_mark.h"

#include "dicot/base/utc_time.h"

#include <algorithm>
#include <cerrno>
#include <utility>

namespace dicot {
namespace {

constexpr std::uint64_t kLeastSnapshotBytes = std::uint64_t{4} << 20; ///< while nothing is known of their size
constexpr std::uint64_t kRoomForSnapshots = 8; ///< as many are let go at once, so that one sync serves them all
constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

/// As names and records have it.
std::int64_t second_of(std::int64_t us)
{
    constexpr std::int64_t kSecondUs = 1'000'000;
    const std::int64_t kept = std::clamp(us, kFirstUtcUs, kLastUtcUs);
    return kept - ((kept % kSecondUs) + kSecondUs) % kSecondUs;
}

class CardStore final : public Store
{
public:
    CardStore(Medium& medium, const StoreRules& rules, ReadingDesk desk)
        : medium_(medium), rules_(rules), desk_(std::move(desk)), incoming_(medium), mark_(medium)
    {
    }
    ~CardStore() override;

    Status start(const std::string& catalogue, const char* vfs);

    const StartReport& start_report() const override { return report_; }
    Catalogue& catalogue() override { return *catalogue_; }
    Status begin(const SlotTime& time) override;
    std::int64_t sequence() const override { return last_; }
    const char* folder() const override { return incoming_.target().c_str(); }
    Status make_room() override;
    Status add(const char* name, FunctionRef<Status(ByteSink&)> fill) override { return incoming_.add(name, fill); }
    void for_each_added(FunctionRef<void(const Added&)> visit) const override { incoming_.for_each_added(visit); }
    Status take_back() override;
    Status commit(const SlotOutcome& outcome) override;
    Status mark_pulled(std::span<const Pull> pulls) override;
    Result<PruneReport> prune(const PruneWish& wish, FunctionRef<void(const SlotRow&)> going) override
    {
        return prune_folders(medium_, *catalogue_, rules_.prune, wish, going);
    }
    Result<VerifyReport> verify(bool repair, FunctionRef<void(const Finding&)> found,
                                FunctionRef<void(int, int)> progress) override;

private:
    Result<std::uint64_t> bytes_wanted();
    Status open_catalogue_and_rows(const std::string& path, const char* vfs, bool was_interrupted);

    Medium& medium_;
    StoreRules rules_;
    ReadingDesk desk_;
    Incoming incoming_;
    std::unique_ptr<Catalogue> catalogue_;
    std::string catalogue_path_;
    const char* vfs_ = nullptr;
    StartReport report_;
    SlotTime time_;
    std::int64_t last_ = 0;
    WritingMark mark_;
    bool rows_missing_ = true; ///< perhaps: the next start looks at all folders
    bool row_owed_ = false;    ///< the same, since the catalogue failed; the next snapshot tries again
};

CardStore::~CardStore()
{
    // Only rows that last let the next start go without a look at all folders.
    if (catalogue_ != nullptr && !rows_missing_ && !row_owed_ && catalogue_->sync().ok())
        mark_.remove();
    catalogue_.reset();
    medium_.unlock();
}

Status CardStore::start(const std::string& path, const char* vfs)
{
    const Errno locked = medium_.lock();
    if (locked.number() == EWOULDBLOCK)
        return failure(Fault::kTryAgain, "another dicot writes to this store; wait until it has finished");
    TRY(on_card(locked, "", "locking it"));
    if (is_archive(medium_))
        return failure(Fault::kUsage, "this is an archive of what was pulled, and no board's store: nothing is written "
                                      "or deleted in it; dicot archive looks after it");
    if (!make_rooms(medium_).ok() && release_ballast(medium_))
        TRY(make_rooms(medium_));
    TRY(make_rooms(medium_));
    TRY(open_catalogue_and_rows(path, vfs, mark_.put()));
    if (!finish_leaving(medium_, *catalogue_).ok())
        ++report_.left_over;
    last_ = std::max(last_, TRY(last_sequence_of(medium_, *catalogue_)));
    if (last_ > TRY(catalogue_->last_sequence())) // of an older day, or folders were copied in
        rows_missing_ = !TRY(add_rows(medium_, *catalogue_, desk_, report_, last_)) || rows_missing_;
    TRY(end_interrupted(medium_, *catalogue_, desk_, rules_.cause, report_));
    rows_missing_ = rows_missing_ || report_.left_over > 0;
    keep_ballast(medium_, rules_.reserve_bytes);
    return {};
}

Status CardStore::open_catalogue_and_rows(const std::string& path, const char* vfs, bool was_interrupted)
{
    catalogue_path_ = path;
    vfs_ = vfs;
    if (auto opened = open_catalogue(medium_, path, vfs, report_); opened.ok())
        catalogue_ = std::move(opened).value();
    else if (release_ballast(medium_))
        catalogue_ = TRY(open_catalogue(medium_, path, vfs, report_));
    else
        return opened.status();
    rows_missing_ = was_interrupted || report_.catalogue_new;
    if (rows_missing_)
        rows_missing_ = !TRY(add_rows(medium_, *catalogue_, desk_, report_, last_));
    return {};
}

Status CardStore::begin(const SlotTime& time)
{
    if (incoming_.begun())
        TRY(end_interrupted(medium_, *catalogue_, desk_, rules_.cause, report_));
    if (row_owed_)
        row_owed_ = !add_rows(medium_, *catalogue_, desk_, report_, last_).ok();
    TRY(mark_.make_sure());
    if (last_ >= kMaxSequence)
        return failure(Fault::kBadData, "the sequence numbers have come to their end at %lld; begin a new store",
                       static_cast<long long>(last_));
    time_.began_us = second_of(time.began_us);
    time_.due_us.reset();
    if (time.due_us)
        time_.due_us = second_of(*time.due_us);
    ++last_; // whatever comes out: the folder may be there although it could not be said
    const PartName part{{last_, time_.began_us}, time_.due_us};
    Status status = incoming_.begin(part);
    if (!status.ok() && !incoming_.begun() && release_ballast(medium_))
        status = incoming_.begin(part);
    return status;
}

Result<std::uint64_t> CardStore::bytes_wanted()
{
    const SlotPace pace = TRY(catalogue_->pace());
    const auto most = static_cast<std::uint64_t>(std::max<std::int64_t>(pace.most_bytes, 0));
    return most > 0 ? most + most / 4 : kLeastSnapshotBytes;
}

Status CardStore::make_room()
{
    const std::uint64_t wanted = TRY(bytes_wanted());
    MediumSpace space;
    TRY(on_card(medium_.space(space), "", "asking for its free space"));
    if (space.free_bytes >= rules_.reserve_bytes + wanted)
        return {};
    PruneWish wish;
    wish.free_bytes = rules_.reserve_bytes + kRoomForSnapshots * wanted;
    TRY(prune(wish, [](const SlotRow&) {}));
    TRY(on_card(medium_.space(space), "", "asking for its free space"));
    if (space.free_bytes >= rules_.reserve_bytes + wanted)
        return {};
    return failure(
        Fault::kIoError,
        "the card is full: %.1f MiB are free, %.1f are left to the system (output.reserve_mib) and a snapshot "
        "needs %.1f; %s",
        static_cast<double>(space.free_bytes) / kMiB, static_cast<double>(rules_.reserve_bytes) / kMiB,
        static_cast<double>(wanted) / kMiB,
        rules_.prune == Prune::kNever    ? "delete snapshots, or let dicot do it (output.prune)"
        : rules_.prune == Prune::kPulled ? "pull snapshots, then those pulled are deleted"
                                         : "take a larger card");
}

Status CardStore::take_back()
{
    TRY(incoming_.take_back());
    constexpr std::uint64_t kRecordRoom = 64 * 1024;
    MediumSpace space;
    if (medium_.space(space).ok() && space.free_bytes < kRecordRoom)
        (void)release_ballast(medium_);
    return {};
}

Status CardStore::commit(const SlotOutcome& outcome)
{
    const bool was_begun = incoming_.begun();
    const Result<Incoming::Settled> settled = incoming_.settle();
    if (!settled.ok()) {
        row_owed_ = row_owed_ || (was_begun && !incoming_.begun());
        return settled.status();
    }
    const Status put = catalogue_->put({.sequence = last_,
                                        .began_us = time_.began_us,
                                        .due_us = time_.due_us,
                                        .done = outcome.done,
                                        .reason = outcome.reason,
                                        .clock_trust = outcome.clock_trust,
                                        .points = outcome.points,
                                        .bytes = settled.value().bytes,
                                        .sums = settled.value().sums,
                                        .pulled_us = {},
                                        .kept = Kept::kHere});
    row_owed_ = row_owed_ || !put.ok(); // stored all the same: the folder says everything that the row does
    keep_ballast(medium_, rules_.reserve_bytes);
    return {};
}

Status CardStore::mark_pulled(std::span<const Pull> pulls)
{
    const Status marked = mark_pulls(medium_, *catalogue_, pulls);
    row_owed_ = row_owed_ || marked.fault() == Fault::kIoError; // some marks may be in their place
    return marked;
}

Result<VerifyReport> CardStore::verify(bool repair, FunctionRef<void(const Finding&)> found,
                                       FunctionRef<void(int, int)> progress)
{
    if (repair && !catalogue_->check().ok()) {
        catalogue_.reset();
        TRY(quarantine(medium_, kCatalogueName));
        if (const Status opened = open_catalogue_and_rows(catalogue_path_, vfs_, true); !opened.ok()) {
            // The card has just failed; what is asked of this store next meets a catalogue all the same.
            if (catalogue_ == nullptr)
                catalogue_ = TRY(Catalogue::open(":memory:", Catalogue::Access::kWrite));
            return opened;
        }
    }
    return verify_folders(medium_, *catalogue_, desk_, repair ? Verify::kAndRepair : Verify::kOwn, found, progress);
}

} // namespace

Result<std::unique_ptr<Store>> Store::open(Medium& medium, const StoreRules& rules, const std::string& catalogue,
                                           const char* vfs)
{
    ReadingDesk desk = TRY(ReadingDesk::make());
    auto store = std::make_unique<CardStore>(medium, rules, std::move(desk));
    TRY(store->start(catalogue, vfs));
    return std::unique_ptr<Store>(std::move(store));
}

Result<std::unique_ptr<Catalogue>> read_catalogue(Medium& medium, const std::string& path)
{
    auto opened = Catalogue::open(path, Catalogue::Access::kRead);
    // Rows may be missing where a writer was interrupted; while one writes they are there.
    if (opened.ok() && (!is_there(medium, kWriting) || is_written_to(medium)))
        return opened;
    auto copy = TRY(Catalogue::open(":memory:", Catalogue::Access::kWrite));
    const ReadingDesk desk = TRY(ReadingDesk::make());
    StartReport report;
    std::int64_t highest = 0;
    (void)TRY(add_rows(medium, *copy, desk, report, highest, Unreadable::kNamed));
    return copy;
}

Result<VerifyReport> verify_store(Medium& medium, const std::string& path, FunctionRef<void(const Finding&)> found,
                                  FunctionRef<void(int, int)> progress)
{
    const std::unique_ptr<Catalogue> catalogue = TRY(read_catalogue(medium, path));
    const ReadingDesk desk = TRY(ReadingDesk::make());
    VerifyReport report = TRY(verify_folders(medium, *catalogue, desk, Verify::kOnly, found, progress));
    // The rows were then made of the folders. A copy has none, and no room for what is being written.
    const auto opened = Catalogue::open(path, Catalogue::Access::kRead);
    const bool is_missed =
        opened.status().fault() == Fault::kNoInput && is_there(medium, kIncoming) && !is_archive(medium);
    if (opened.status().fault() == Fault::kBadData || is_missed) {
        ++report.findings;
        found({Finding::Kind::kCatalogue, 0, Store::kCatalogueName, opened.status().message(), false});
    }
    return report;
}

} // namespace dicot
