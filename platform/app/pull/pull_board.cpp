#include "pull_board.h"

#include "pull_marks.h"

#include "../config/device_name.h"
#include "../stop_request.h"
#include "../store/shown.h"
#include "../store/store_outcome.h"

#include "dicot/medium/disk_medium.h"
#include "dicot/os/clock_trust.h"
#include "dicot/os/wait.h"
#include "dicot/pull_archive/board_archive.h"
#include "dicot/record/record.h"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

namespace dicot::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostOffered = 1'000'000; ///< two years of a snapshot a minute
constexpr int kMostFailuresInARow = 8;
constexpr const char* kStopped = "stopped; the next pull goes on there";

Status ready_folder(const std::string& archive, const std::string& board)
{
    const Result<bool> is_board = is_device_folder(archive);
    if (is_board.ok() && is_board.value())
        return failure(Fault::kUsage, "%s: it is itself the folder of one board: name the one around it",
                       shown(archive).c_str());
    std::error_code error;
    fs::create_directories(board, error);
    if (error)
        return failure(Fault::kCannotCreate, "%s: it cannot be made (%s): name another folder for the archive",
                       shown(board).c_str(), error.message().c_str());
    return {};
}

class BoardPull
{
public:
    BoardPull(PullSource& source, const PullWishes& wishes, PullScreen& screen, PullReport& report)
        : source_(source), wishes_(wishes), screen_(screen), report_(report),
          marks_(source, report, wishes.mark_patience_us)
    {
    }

    Status run();

private:
    Status list();
    bool is_wanted(const OfferedSnapshot& offered);
    Status take_all();
    Status take_one(const OfferedSnapshot& offered, int line);
    void count(const OfferedSnapshot& offered, const Taken& taken);
    void offer_time();
    Status verdict() const;
    std::string prefix(const OfferedSnapshot& offered) const;

    PullSource& source_;
    const PullWishes& wishes_;
    PullScreen& screen_;
    PullReport& report_;
    PullMarks marks_;
    std::unique_ptr<Medium> medium_;
    std::unique_ptr<BoardArchive> archive_; ///< goes before the medium
    std::vector<OfferedSnapshot> wanted_;
    std::int64_t wanted_fresh_ = 0;
    std::uint64_t wanted_bytes_ = 0;
    bool sizes_known_ = true;
    NumberRanges had_;
    int failures_ = 0; ///< in a row
    bool went_away_ = false;
};

Status BoardPull::run()
{
    const std::string folder = wishes_.archive + "/" + report_.device;
    TRY(ready_folder(wishes_.archive, folder));
    medium_ = TRY(open_disk_medium(folder));
    Result<std::unique_ptr<BoardArchive>> archive = BoardArchive::open(*medium_, source_.serial());
    TRY(in_store(folder, archive.status()));
    archive_ = std::move(archive).value();
    if (wishes_.set_clock)
        offer_time();
    TRY(list());
    const Status taken = in_store(folder, take_all());
    marks_.tell(!StopRequest::asked() && !went_away_);
    const Status noted = in_store(folder, archive_->note({utc_now_us(), std::move(had_)}));
    TRY(taken);
    TRY(noted);
    return verdict();
}

Status BoardPull::list()
{
    std::int64_t before = 0;
    Status wrong;
    TRY(source_.snapshots(1, [&](const OfferedSnapshot& offered) {
        // The same number twice is for take() to judge; it cannot go backwards.
        if (offered.sequence < std::max<std::int64_t>(before, 1) || offered.sequence > kMaxSequence)
            wrong = failure(Fault::kBadData, "the list of its snapshots is not in order: it is no dicot, or damaged");
        else if (static_cast<std::size_t>(report_.offered) == kMostOffered)
            wrong = failure(Fault::kBadData, "it lists more snapshots than a board ever has");
        if (!wrong.ok())
            return false;
        before = offered.sequence;
        ++report_.offered;
        had_.add(offered.sequence);
        if (is_wanted(offered)) {
            wanted_.push_back(offered);
            if (!archive_->find(offered.sequence)) {
                ++wanted_fresh_;
                sizes_known_ = sizes_known_ && offered.bytes.has_value();
                wanted_bytes_ += std::min(offered.bytes.value_or(0), std::uint64_t{1} << 40U);
            }
        }
        return !StopRequest::asked();
    }));
    TRY(wrong);
    if (StopRequest::asked()) // half a list is none
        return failure(Fault::kTryAgain, "%s", kStopped);
    return {};
}

bool BoardPull::is_wanted(const OfferedSnapshot& offered)
{
    if (wishes_.since_us && offered.began_us < *wishes_.since_us) {
        ++report_.earlier;
        return false;
    }
    const std::optional<std::int64_t> here = archive_->find(offered.sequence);
    if (!offered.pulled || archive_->is_owed(offered.sequence))
        return true;
    if (here && (wishes_.verify || *here != offered.began_us))
        return true;
    if (here) { // and the board knows it
        ++report_.there;
        return false;
    }
    report_.elsewhere += wishes_.all ? 0 : 1;
    return wishes_.all;
}

Status BoardPull::take_all()
{
    const int line =
        screen_.begin(report_.device, std::ssize(wanted_), wanted_fresh_, sizes_known_ ? wanted_bytes_ : 0);
    Status status;
    for (std::size_t k = 0; k < wanted_.size() && status.ok(); ++k) {
        if (StopRequest::asked())
            status = failure(Fault::kTryAgain, "%s", kStopped);
        else
            status = take_one(wanted_[k], line);
    }
    screen_.end(line);
    return status;
}

Status BoardPull::take_one(const OfferedSnapshot& offered, int line)
{
    const auto arrived = [&](std::uint64_t bytes) {
        screen_.arrived(line, bytes);
        return !StopRequest::asked();
    };
    Result<Taken> taken = archive_->take(source_, offered, wishes_.verify, arrived);
    went_away_ = taken.status().fault() == Fault::kUnavailable;
    if (went_away_)
        return failure(Fault::kTryAgain,
                       "it went away after %lld of %zu snapshots (%.150s); plug it in and pull again: it "
                       "goes on there",
                       static_cast<long long>(report_.fresh + report_.there), wanted_.size(), taken.status().message());
    TRY(taken.status());
    if (StopRequest::asked() && taken.value().how == Took::kUnreadable)
        return failure(Fault::kTryAgain, "%s", kStopped);
    screen_.one_done(line);
    count(offered, taken.value());
    failures_ = taken.value().how == Took::kUnreadable ? failures_ + 1 : 0;
    if (failures_ < kMostFailuresInARow)
        return {};
    return failure(Fault::kTryAgain,
                   "%d snapshots in a row could not be read: check cable, reader and card, then pull "
                   "again",
                   failures_);
}

std::string BoardPull::prefix(const OfferedSnapshot& offered) const
{
    return shown(report_.device) + ": snapshot " + std::to_string(offered.sequence) + ": ";
}

void BoardPull::count(const OfferedSnapshot& offered, const Taken& taken)
{
    switch (taken.how) {
    case Took::kNew:
        ++report_.fresh;
        report_.bytes += taken.bytes;
        break;
    case Took::kThere:
        ++report_.there;
        break;
    case Took::kConflict:
        ++report_.conflicts;
        break;
    case Took::kDamaged:
        ++report_.damaged;
        break;
    case Took::kGone:
        ++report_.gone;
        break;
    case Took::kUnreadable:
        ++report_.unreadable;
        break;
    }
    if (taken.stays_damaged) {
        ++report_.damaged_here;
        screen_.say(prefix(offered) + "it is damaged here, and could not be taken anew; it stays until it can");
    }
    if (taken.put_aside) {
        ++report_.put_aside;
        screen_.say(prefix(offered) + "it was damaged here; that copy is in quarantine/ now");
    }
    if (taken.how == Took::kNew || taken.how == Took::kThere) {
        if (!offered.pulled)
            marks_.add({offered.sequence, taken.sums});
    } else if (taken.how != Took::kGone)
        screen_.say(prefix(offered) + shown(taken.why.message()));
}

/// A clock that is itself wrong is no help to a board.
void BoardPull::offer_time()
{
    const ClockReading clock = read_clock({});
    if (clock.trust == ClockTrust::kNotSet) {
        report_.clock = std::string{"not offered: this computer's own clock is not set: "} + clock.why;
        return;
    }
    const Status offered = source_.offer_time(clock.now_us);
    report_.clock = offered.ok() ? "set" : std::string{"not taken: "} + offered.message();
}

Status BoardPull::verdict() const
{
    if (report_.damaged > 0 || report_.conflicts > 0)
        return failure(Fault::kBadData,
                       "%s damaged at the source, %lld in conflict with the archive: named above; dicot "
                       "verify --repair on the board puts damaged ones aside",
                       counted(report_.damaged, "snapshot").c_str(), static_cast<long long>(report_.conflicts));
    if (report_.mark_refused > 0)
        return failure(
            Fault::kBadData,
            "the board took no mark for %s that came from it: its digests there are others now; dicot verify "
            "on the board says more",
            counted(report_.mark_refused, "snapshot").c_str());
    if (report_.unreadable > 0)
        return failure(Fault::kTryAgain, "%s could not be read now: pull again",
                       counted(report_.unreadable, "snapshot").c_str());
    if (report_.damaged_here > 0)
        return failure(Fault::kBadData, "%s damaged here and not to be had from this source: pull from another one",
                       counted(report_.damaged_here, "snapshot").c_str());
    if (report_.unmarked > 0)
        return failure(Fault::kTryAgain,
                       "everything is here, but the board was too busy to be told of %s: the next pull tells it",
                       counted(report_.unmarked, "snapshot").c_str());
    return {};
}

} // namespace

Status BoardNames::claim(const PullSource& source)
{
    const std::scoped_lock lock(mutex_);
    const auto [there, is_new] = where_.emplace(source.device(), source.where());
    if (is_new)
        return {};
    return failure(Fault::kBadData,
                   "%s and %s are both called %s: give one of them another name (output.device), or pull it alone into "
                   "another archive",
                   shown(there->second).c_str(), shown(source.where()).c_str(), shown(source.device()).c_str());
}

PullReport pull_board(PullSource& source, const PullWishes& wishes, BoardNames& names, PullScreen& screen)
{
    PullReport report;
    report.device = source.device();
    report.serial = source.serial();
    report.where = source.where();
    report.takes_marks = source.takes_marks();
    if (!is_device_name(report.device))
        report.outcome = failure(Fault::kBadData, "a board cannot be called %s", shown(report.device).c_str());
    else
        report.outcome = names.claim(source);
    if (report.outcome.ok())
        report.outcome = BoardPull(source, wishes, screen, report).run();
    return report;
}

} // namespace dicot::app
