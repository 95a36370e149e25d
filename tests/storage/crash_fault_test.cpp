// The store on a card that fails: at its Nth operation, once or from then on. DICOT_CRASH_FAULT=eio:37 replays one
// case.
#include "crash_cases.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <ostream>

using namespace dicot;
using namespace dicot::test;

namespace {

struct FaultRow
{
    const char* name;
    int error;
    bool lasts;
    int every; ///< each operation, or one of so many
};

void PrintTo(const FaultRow& row, std::ostream* out)
{
    *out << row.name;
}

constexpr FaultRow kTable[] = {
    {"eio", EIO, false, 1},         {"eio-on", EIO, true, 5},   {"enospc", ENOSPC, false, 1},
    {"enospc-on", ENOSPC, true, 2}, {"erofs", EROFS, false, 2}, {"erofs-on", EROFS, true, 3},
};

class StoreOnFailingCard : public ::testing::TestWithParam<FaultRow>
{
protected:
    /// False: the fault did not come any more.
    bool strike(int at);

    CrashScene scene_;
    int cases_ = 0, refusals_ = 0, misses_ = 0;
};

bool StoreOnFailingCard::strike(int at)
{
    const FaultRow& row = GetParam();
    const std::string name = std::string{row.name} + ":" + std::to_string(at);
    ++cases_;
    CrashMedium card;
    card.set_fault({row.error, at, row.lasts});
    const Story story = tell(card, scene_.vfs());
    const int struck = card.struck();
    card.set_fault({});
    refusals_ += story.refusals;
    misses_ += story.misses;
    EXPECT_LE(story.refusals, row.lasts ? 1000 : 1)
        << name << ": one fault, and more than one refusal, first " << story.first_refusal;
    const Moment end = card.log().size();
    for (const unsigned seed : {0U, 5U}) {
        CrashMedium after{surviving({}, card.log(), {Cut::Mode::kSubset, end, seed})};
        for (const std::string& sentence : judge(after, scene_.vfs(), story, end).verdict)
            ADD_FAILURE() << name << ", then power loss " << seed << ": " << sentence;
    }
    for (const std::string& sentence : judge(card, scene_.vfs(), story, end).verdict)
        ADD_FAILURE() << name << ": " << sentence;
    return struck != 0;
}

TEST_P(StoreOnFailingCard, says_no_and_goes_on_when_the_fault_is_gone)
{
    const std::string row = GetParam().name;
    if (const char* only = std::getenv("DICOT_CRASH_FAULT")) {
        int at = 0;
        if (std::sscanf(only, (row + ":%d").c_str(), &at) == 1)
            (void)strike(at);
        return;
    }
    for (int at = 0; strike(at) && !HasFailure();)
        at += GetParam().every;
    std::printf("%d cases, %d refusals, %d misses recorded\n", cases_, refusals_, misses_);
    EXPECT_GT(refusals_, 0);
}

INSTANTIATE_TEST_SUITE_P(Table, StoreOnFailingCard, ::testing::ValuesIn(kTable), [](const auto& row) {
    std::string name = row.param.name;
    for (char& c : name)
        c = c == '-' ? '_' : c;
    return name;
});

class StoreOnFullCard : public ::testing::Test
{
protected:
    CrashScene scene_;
};

TEST_F(StoreOnFullCard, records_misses_and_keeps_what_it_has)
{
    CrashMedium card;
    card.set_capacity(std::uint64_t{6} << 20);
    StoryRules rules;
    rules.most_file_bytes = 400'000;
    rules.store.prune = Prune::kNever;
    const Story story = tell_until_full(card, scene_.vfs(), rules, 40);
    int done = 0;
    for (const Told& told : story.all)
        done += told.acknowledged != kNever && told.contents.back().done ? 1 : 0;
    std::printf("%d snapshots, %d misses, %d refusals, first %s\n", done, story.misses, story.refusals,
                story.first_refusal.c_str());
    EXPECT_GT(done, 5);
    EXPECT_GT(story.misses, 10);
    EXPECT_EQ(done + story.misses, 40) << "each slot is either stored or a recorded miss";
    card.set_capacity(CrashMedium::kCapacityBytes);
    for (const std::string& sentence : judge(card, scene_.vfs(), story, card.log().size()).verdict)
        ADD_FAILURE() << sentence;
}

TEST_F(StoreOnFullCard, records_a_miss_when_another_program_takes_the_last_block)
{
    CrashMedium card;
    StoryRules rules;
    rules.most_file_bytes = 20'000;
    const Story story = tell_with_a_thief(card, scene_.vfs(), rules);
    EXPECT_EQ(story.misses, 1) << story.first_refusal;
    card.set_capacity(CrashMedium::kCapacityBytes);
    for (const std::string& sentence : judge(card, scene_.vfs(), story, card.log().size()).verdict)
        ADD_FAILURE() << sentence;
}

} // namespace
