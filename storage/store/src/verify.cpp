#include "verify.h"

#include "pulls.h"
#include "start_up.h"

#include "dicot/base/utc_time.h"

#include <algorithm>
#include <cerrno>
#include <span>
#include <string>
#include <vector>

namespace dicot {
namespace {

class Verifier
{
public:
    Verifier(Medium& medium, Catalogue& catalogue, const ReadingDesk& desk, Verify how,
             FunctionRef<void(const Finding&)> found)
        : medium_(medium), catalogue_(catalogue), desk_(desk), how_(how), found_(found)
    {
    }

    Result<VerifyReport> run(FunctionRef<void(int, int)> progress);

private:
    using Kind = Finding::Kind;

    bool repairs() const { return how_ == Verify::kAndRepair; }
    void find(Kind kind, std::int64_t sequence, const StorePath& path, const char* sentence, bool mended = false);
    Status look_at_root();
    void list_day(const StorePath& day);
    enum class State
    {
        kWhole,
        kDamaged,
        kUnreadable, ///< nobody can say: nothing is moved
    };
    Result<State> check_folder(const StorePath& folder, const SnapshotName& name);
    /// What is wrong with a file, and what follows for its folder.
    State judge(const Status& status, std::int64_t sequence, const StorePath& path);
    /// All folders that bear one number: one of them is the snapshot.
    Status check_number(std::span<const SnapshotName> names);
    /// A damaged mark is named, and written anew if the catalogue remembers the pull.
    Status check_pulled(const StorePath& folder, const SlotRow& row);
    Status look_for_strangers(const StorePath& folder, const SnapshotName& name, const Sums& sums);
    Status compare_row(const StorePath& folder, const SnapshotName& name);
    Status take_away(const StorePath& folder, const SnapshotName& name);
    Status look_for_lost();
    Status look_for_left_overs();

    Medium& medium_;
    Catalogue& catalogue_;
    const ReadingDesk& desk_;
    Verify how_;
    FunctionRef<void(const Finding&)> found_;
    VerifyReport report_;
    std::vector<SnapshotName> names_; ///< ascending
    bool all_listed_ = true;
};

void Verifier::find(Kind kind, std::int64_t sequence, const StorePath& path, const char* sentence, bool mended)
{
    ++report_.findings;
    report_.mended += mended ? 1 : 0;
    const std::string_view words = sentence; // that of a failure names the path itself
    if (words.size() > path.view().size() + 2 && words.starts_with(path.view()))
        sentence += path.view().size() + 2;
    found_({kind, sequence, path.c_str(), sentence, mended});
}

/// Also one that is being written, or is to be replaced.
bool is_note_of_archive(std::string_view name)
{
    for (const std::string_view note : {kArchiveMark, kBoardFile, kLastPullFile})
        if (name.starts_with(note) && (name == note || name.substr(note.size()) == ".new"))
            return true;
    return false;
}

/// What the store makes beside the days.
bool is_known(const MediumEntry& entry)
{
    if (entry.kind == EntryKind::kFolder)
        return entry.name == kIncoming || entry.name == kLeaving || entry.name == kQuarantine;
    const std::string_view catalogue = Store::kCatalogueName;
    return entry.kind == EntryKind::kFile &&
           (entry.name == kBallast || entry.name == kWriting || is_note_of_archive(entry.name) ||
            (entry.name.starts_with(catalogue) &&
             (entry.name.size() == catalogue.size() || entry.name.substr(catalogue.size()) == "-wal" ||
              entry.name.substr(catalogue.size()) == "-shm" || entry.name.substr(catalogue.size()) == "-journal")));
}

Status Verifier::look_at_root()
{
    std::vector<std::string> days;
    TRY(on_card(medium_.list("",
                             [&](const MediumEntry& entry) {
                                 if (entry.kind == EntryKind::kFolder && is_day_name(entry.name))
                                     days.emplace_back(entry.name);
                                 else if (!is_known(entry) && entry.name != "lost+found")
                                     find(Kind::kStranger, 0, entry.name, "dicot did not make it");
                                 return true;
                             }),
                "", "listing it"));
    for (const std::string& day : days)
        list_day(day.c_str());
    std::sort(names_.begin(), names_.end(), [](const SnapshotName& a, const SnapshotName& b) {
        return a.sequence != b.sequence ? a.sequence < b.sequence : a.began_us < b.began_us;
    });
    return {};
}

void Verifier::list_day(const StorePath& day)
{
    const Errno listed = medium_.list(day.c_str(), [&](const MediumEntry& entry) {
        const auto name = parse_snapshot_name(entry.name);
        if (entry.kind == EntryKind::kFolder && name && utc_day(name->began_us).view() == day.view())
            names_.push_back(*name);
        else
            find(Kind::kStranger, 0, join(day.view(), entry.name), "dicot did not make it");
        return true;
    });
    if (listed.ok())
        return;
    all_listed_ = false;
    find(Kind::kDamaged, 0, day, on_card(listed, day.c_str(), "listing it").message());
}

Verifier::State Verifier::judge(const Status& status, std::int64_t sequence, const StorePath& path)
{
    const bool is_moved = repairs() && is_damage(status);
    find(status.fault() == Fault::kNoInput ? Kind::kMissing : Kind::kDamaged, sequence, path, status.message(),
         is_moved);
    return is_damage(status) ? State::kDamaged : State::kUnreadable;
}

Result<Verifier::State> Verifier::check_folder(const StorePath& folder, const SnapshotName& name)
{
    const Result<ReadSums> read = read_sums(medium_, folder);
    const StorePath sums_path = join(folder.view(), kSums);
    if (!read.ok())
        return judge(read.status(), name.sequence, sums_path);
    const ReadSums& sums = read.value();
    const std::optional<SlotRow> row = TRY(catalogue_.find(name.sequence));
    // A digest, or a name, that does not fit may be wrong itself: then the catalogue has another digest of SHA256SUMS.
    const bool sums_differ = row && row->began_us == name.began_us && !row->sums.empty() && row->sums != sums.sha256;
    State state = State::kWhole;
    for (const Sum& sum : sums.sums.all()) {
        const Status status = check_file(medium_, folder, sum, desk_, report_.bytes);
        if (status.ok())
            continue;
        if (sums_differ && is_damage(status)) {
            find(Kind::kDamaged, name.sequence, sums_path, "its bytes are not those that were stored", repairs());
            return State::kDamaged;
        }
        state = std::max(state, judge(status, name.sequence, join(folder.view(), sum.name.view())));
    }
    if (state == State::kWhole)
        if (const Result<SlotRow> facts = row_of(medium_, folder, name, desk_); !facts.ok())
            state = judge(facts.status(), name.sequence, join(folder.view(), kRecord));
    TRY(look_for_strangers(folder, name, sums.sums));
    return state;
}

Status Verifier::check_number(std::span<const SnapshotName> names)
{
    const std::optional<SlotRow> row = TRY(catalogue_.find(names[0].sequence));
    std::vector<State> states;
    std::optional<std::size_t> snapshot;
    for (std::size_t i = 0; i < names.size(); ++i) {
        ++report_.folders;
        states.push_back(TRY(check_folder(folder_of(row_named(names[i])), names[i])));
        const bool is_the_rows = row && row->began_us == names[i].began_us;
        if (states[i] == State::kWhole && (!snapshot || is_the_rows))
            snapshot = i;
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        const StorePath folder = folder_of(row_named(names[i]));
        if (snapshot == i) {
            TRY(compare_row(folder, names[i]));
            continue;
        }
        if (states[i] == State::kWhole)
            find(Kind::kDamaged, names[i].sequence, folder, "another folder has its number", repairs());
        if (repairs() && states[i] != State::kUnreadable)
            TRY(take_away(folder, names[i]));
    }
    return {};
}

Status Verifier::check_pulled(const StorePath& folder, const SlotRow& row)
{
    const StorePath path = join(folder.view(), kPulledMark);
    const bool mended = repairs() && medium_.remove_file(path.c_str()).ok();
    if (mended)
        TRY(restore_mark(medium_, row));
    find(Kind::kDamaged, row.sequence, path, "the mark of a pull is damaged", mended);
    return {};
}

Status Verifier::look_for_strangers(const StorePath& folder, const SnapshotName& name, const Sums& sums)
{
    const Errno listed = medium_.list(folder.c_str(), [&](const MediumEntry& entry) {
        if (entry.kind != EntryKind::kFile ||
            (entry.name != kSums && entry.name != kPulledMark && sums.find(entry.name) == nullptr))
            find(Kind::kStranger, name.sequence, join(folder.view(), entry.name), "SHA256SUMS does not have it");
        return true;
    });
    return on_card(listed, folder.c_str(), "listing it");
}

Status Verifier::compare_row(const StorePath& folder, const SnapshotName& name)
{
    const std::optional<SlotRow> row = TRY(catalogue_.find(name.sequence));
    SlotRow facts = TRY(row_of(medium_, folder, name, desk_));
    if (!facts.pulled_us && is_there(medium_, join(folder.view(), kPulledMark).c_str())) {
        if (row && row->sums == facts.sums)
            facts.pulled_us = row->pulled_us;
        TRY(check_pulled(folder, facts));
    }
    if (row && *row == facts)
        return {};
    if (repairs())
        TRY(catalogue_.put(facts));
    find(Kind::kCatalogue, name.sequence, folder,
         row ? "the catalogue has something else than the folder" : "the catalogue does not have it", repairs());
    return {};
}

Status Verifier::take_away(const StorePath& folder, const SnapshotName& name)
{
    TRY(quarantine(medium_, folder));
    TRY(on_card(medium_.sync_all(), kQuarantine, "syncing"));    // before its day goes
    (void)medium_.remove_folder(utc_day(name.began_us).c_str()); // if it was the last one of its day
    std::optional<SlotRow> row = TRY(catalogue_.find(name.sequence));
    if (row && row->began_us != name.began_us)
        return {};
    SlotRow moved = row.value_or(row_named(name));
    if (!row)
        moved.reason = "damaged, and the catalogue did not have it";
    moved.kept = Kept::kQuarantined;
    return catalogue_.put(moved);
}

Status Verifier::look_for_lost()
{
    std::vector<SlotRow> lost;
    auto next = names_.begin();
    TRY(catalogue_.for_each({}, [&](const SlotRow& row) {
        while (next != names_.end() && next->sequence < row.sequence)
            ++next;
        const bool here = next != names_.end() && next->sequence == row.sequence;
        if (row.kept == Kept::kHere && !here)
            lost.push_back(row);
        return true;
    }));
    for (SlotRow& row : lost) {
        const bool mended = repairs();
        const StorePath aside = join(kQuarantine, snapshot_name({row.sequence, row.began_us}).view());
        const bool moved = is_there(medium_, aside.c_str()); // and then the power went
        row.kept = moved ? Kept::kQuarantined : Kept::kLost;
        if (mended)
            TRY(catalogue_.put(row));
        const char* const where = moved ? "it is in quarantine" : "the folder is not there";
        find(Kind::kMissing, row.sequence, folder_of(row), where, mended);
    }
    return {};
}

Status Verifier::look_for_left_overs()
{
    const bool probes = how_ == Verify::kOnly;
    if (probes && medium_.lock().number() == EWOULDBLOCK)
        return {}; // it is being written
    for (const char* const room : {kIncoming, kLeaving}) {
        const Errno listed = medium_.list(room, [&](const MediumEntry& entry) {
            find(Kind::kLeftOver, 0, join(room, entry.name), "an interruption left it; the next start ends it");
            return true;
        });
        if (!listed.ok() && listed.number() != ENOENT) {
            if (probes)
                medium_.unlock();
            return on_card(listed, room, "listing it");
        }
    }
    if (probes)
        medium_.unlock();
    return {};
}

Result<VerifyReport> Verifier::run(FunctionRef<void(int, int)> progress)
{
    if (const Status sound = catalogue_.check(); !sound.ok())
        find(Kind::kCatalogue, 0, Store::kCatalogueName, sound.message());
    TRY(look_at_root());
    const std::size_t all = names_.size();
    for (std::size_t i = 0, next = 0; i < all; i = next) {
        progress(static_cast<int>(i), static_cast<int>(all));
        for (next = i; next < all && names_[next].sequence == names_[i].sequence; ++next)
            ;
        if (!is_there(medium_, folder_of(row_named(names_[i])).c_str())) // pruned meanwhile
            continue;
        if (const Status status = check_number(std::span(names_).subspan(i, next - i)); !status.ok()) {
            if (status.fault() != Fault::kIoError)
                return status;
            find(Kind::kDamaged, names_[i].sequence, folder_of(row_named(names_[i])), status.message());
        }
    }
    progress(static_cast<int>(all), static_cast<int>(all));
    if (all_listed_) // of a day that cannot be listed nothing is known to be lost
        TRY(look_for_lost());
    TRY(look_for_left_overs());
    if (repairs())
        TRY(catalogue_.sync());
    report_.in_quarantine = count_quarantine(medium_);
    return report_;
}

} // namespace

Result<VerifyReport> verify_folders(Medium& medium, Catalogue& catalogue, const ReadingDesk& desk, Verify how,
                                    FunctionRef<void(const Finding&)> found,
                                    FunctionRef<void(int done, int all)> progress)
{
    return Verifier(medium, catalogue, desk, how, found).run(progress);
}

bool is_written_to(Medium& medium)
{
    const Errno locked = medium.lock();
    if (locked.ok())
        medium.unlock();
    return locked.number() == EWOULDBLOCK;
}

} // namespace dicot
