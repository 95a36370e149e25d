// Power cuts while a pull writes: what was taken stays, the rest is there whole or not at all, and the next pull ends
// it.
#include "crash_medium.h"
#include "pull_scene.h"

#include <set>

using namespace dicot;
using namespace dicot::test;

namespace {

constexpr int kSnapshots = 3;

/// What an archive had acknowledged after so many changes of the card.
struct Acknowledged
{
    std::size_t at = 0;
    int snapshots = 0;
};

class PullAndPowerCut : public ::testing::Test
{
protected:
    PullAndPowerCut()
    {
        for (int k = 1; k <= kSnapshots; ++k)
            source_.all.push_back(honest(k, kNoon + k * std::int64_t{40'000'000'000}, 3000)); // two days
        source_.most_at_once = 1000;
        const auto archive = BoardArchive::open(medium_, source_.serial());
        EXPECT_TRUE(archive.ok());
        for (const ScriptedSnapshot& one : source_.all) {
            EXPECT_TRUE(archive.value()->take(source_, one.offer, false, goes_on).ok());
            acknowledged_.push_back({medium_.log().size(), static_cast<int>(acknowledged_.size()) + 1});
        }
        NumberRanges had;
        had.add(1);
        EXPECT_TRUE(archive.value()->note({kNoon, had}).ok());
    }

    static std::string folder_of(const ScriptedSnapshot& one)
    {
        char name[64];
        std::snprintf(name, sizeof name, "%s/%06d_%s", utc_day(one.offer.began_us).c_str(),
                      static_cast<int>(one.offer.sequence), utc_stamp(one.offer.began_us).c_str());
        return name;
    }
    int acknowledged_at(std::size_t at) const
    {
        int snapshots = 0;
        for (const Acknowledged& one : acknowledged_)
            snapshots = one.at <= at ? one.snapshots : snapshots;
        return snapshots;
    }
    /// What is wrong with the card after the cut, and after one more pull; empty: nothing.
    std::string judge(const CardState& card, int acknowledged)
    {
        CrashMedium medium(card);
        for (int k = 0; k < kSnapshots; ++k) {
            const ScriptedSnapshot& one = source_.all[static_cast<std::size_t>(k)];
            const bool there = is_there(medium, folder_of(one));
            if (k < acknowledged && !there)
                return "an acknowledged snapshot is lost";
            if (there && !is_whole_copy(medium, folder_of(one), one))
                return "half a snapshot is in its place";
        }
        ScriptedSource again;
        again.all = source_.all;
        const auto archive = BoardArchive::open(medium, again.serial());
        if (!archive.ok())
            return archive.status().message();
        for (const ScriptedSnapshot& one : again.all) {
            const Result<Taken> taken = archive.value()->take(again, one.offer, false, goes_on);
            if (!taken.ok() || (taken.value().how != Took::kNew && taken.value().how != Took::kThere))
                return "the next pull fails";
            if (!is_whole_copy(medium, folder_of(one), one))
                return "the next pull leaves something wrong";
        }
        return names_in(medium, "incoming").empty() ? "" : "the next pull leaves something in incoming/";
    }
    std::vector<std::string> failures_with(const std::vector<Change>& log, Cut::Mode mode, unsigned seeds)
    {
        std::vector<std::string> failures;
        std::set<std::pair<std::uint64_t, int>> seen;
        for (std::size_t at = 0; at <= log.size(); ++at)
            for (unsigned seed = 1; seed <= seeds; ++seed) {
                const Cut cut{mode, at, seed};
                const CardState card = surviving(medium_.start(), log, cut);
                const int acknowledged = acknowledged_at(at);
                if (!seen.insert({card.fingerprint(), acknowledged}).second)
                    continue;
                if (const std::string wrong = judge(card, acknowledged); !wrong.empty())
                    failures.push_back(cut.text() + ": " + wrong);
            }
        std::printf("%zu changes, %zu states\n", log.size(), seen.size());
        return failures;
    }
    static std::string first_of(const std::vector<std::string>& failures)
    {
        return failures.empty() ? "" : failures.front();
    }

    CrashMedium medium_;
    ScriptedSource source_;
    std::vector<Acknowledged> acknowledged_;
};

TEST_F(PullAndPowerCut, loses_nothing_and_leaves_nothing_half_at_any_change)
{
    EXPECT_EQ(first_of(failures_with(medium_.log(), Cut::Mode::kInOrder, 1)), "");
    EXPECT_EQ(first_of(failures_with(medium_.log(), Cut::Mode::kSubset, 6)), "");
    EXPECT_EQ(first_of(failures_with(medium_.log(), Cut::Mode::kTorn, 6)), "");
}

TEST_F(PullAndPowerCut, is_judged_by_somebody_who_can_say_no)
{
    std::vector<Change> forgetful = medium_.log();
    for (Change& change : forgetful)
        if (change.kind == Change::Kind::kSyncAll)
            change.kind = Change::Kind::kSyncNames;
    const std::vector<std::string> failures = failures_with(forgetful, Cut::Mode::kSubset, 6);
    EXPECT_FALSE(failures.empty()) << "names were synced, and no data";
    std::vector<Change> late = medium_.log();
    for (Change& change : late)
        if (change.kind == Change::Kind::kSyncFolder)
            change.kind = Change::Kind::kNothing;
    EXPECT_FALSE(failures_with(late, Cut::Mode::kSubset, 6).empty()) << "the last rename was never synced";
}

/// Each operation of the disk fails in its turn, once.
TEST_F(PullAndPowerCut, costs_one_refusal_for_each_error_of_the_disk)
{
    int refusals = 0;
    for (int at = 0;; ++at) {
        CrashMedium medium;
        ScriptedSource source;
        source.all = source_.all;
        source.most_at_once = 1000;
        medium.set_fault({EIO, at, false});
        const auto pull = [&]() -> Status {
            const auto archive = TRY(BoardArchive::open(medium, source.serial()));
            for (const ScriptedSnapshot& one : source.all) {
                const Taken taken = TRY(archive->take(source, one.offer, false, goes_on));
                if (taken.how != Took::kNew && taken.how != Took::kThere)
                    return failure(Fault::kSoftware, "%s", taken.why.message());
            }
            return {};
        };
        const Status first = pull();
        const bool struck = medium.struck() > 0;
        medium.set_fault({});
        refusals += first.ok() ? 0 : 1;
        if (!first.ok()) {
            EXPECT_EQ(first.fault(), Fault::kIoError) << "operation " << at << ": " << first.message();
            ASSERT_TRUE(pull().ok()) << "operation " << at;
        }
        for (const ScriptedSnapshot& one : source.all)
            ASSERT_TRUE(is_whole_copy(medium, folder_of(one), one)) << "operation " << at;
        if (!struck)
            break;
    }
    EXPECT_GT(refusals, 30);
}

} // namespace
