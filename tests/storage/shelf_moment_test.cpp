// A shelf while a store is written to, pruned, or was cut off from its power.
#include "crash_medium.h"
#include "shelf_scene.h"

#include "dicot/os/sha256.h"
#include "dicot/store/sums.h"

#include <optional>

namespace dicot::test {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kDay = 86'400 * kSecond;

class ShelfMoment : public ShelfScene
{
};

/// Somebody prunes while a snapshot is looked at, at any moment.
class Hasty final : public PassingMedium
{
public:
    using PassingMedium::PassingMedium;
    Errno open(const char* path, File& file, std::uint64_t& size) override
    {
        if (left-- == 0)
            fs::rename(from, to);
        return PassingMedium::open(path, file, size);
    }
    int left = -1;
    std::string from, to;
};

TEST_F(ShelfMoment, OneThatIsMovedAwayWhileItIsLookedAtIsGoneAndNotDamaged)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    ASSERT_TRUE(store_one(store, kNoon + kSecond).ok());
    close();
    auto disk = open_disk_medium(root()).value();
    Hasty card(*disk);
    card.from = at(name_of({1, kNoon}));
    card.to = at("leaving/000001_20260601T120000Z");
    for (int moment = 0; moment < 5; ++moment) { // SHA256SUMS, three files, PULLED
        open_shelf({64, 16}, &card);
        card.left = moment;
        const auto files = shelf().files(1);
        if (files.ok())
            EXPECT_EQ(moment, 4) << "all that was needed had been seen";
        else
            EXPECT_EQ(files.status().fault(), Fault::kNoInput) << files.status().message();
        EXPECT_EQ(shelf().hidden().damaged, 0U);
        EXPECT_EQ(bytes_at(1, 0)[0], '!');
        EXPECT_EQ(bytes_at(2, 0), "the points");
        EXPECT_EQ(shelf().hidden().damaged, 0U);
        ASSERT_TRUE(refresh().ok());
        EXPECT_EQ(told, std::vector<std::string>{"-" + name_of({1, kNoon})});
        fs::rename(card.to, card.from);
    }
    open_shelf();
}

/// Whether a file has the digest that SHA256SUMS says.
bool is_whole(SnapshotShelf& shelf, std::int64_t sequence, int files)
{
    std::string bytes(10'000, 'x');
    std::size_t got = 0;
    const auto text = [&](int member) {
        const Status read = shelf.read(sequence, member, 0, std::as_writable_bytes(std::span(bytes)), got);
        return read.ok() ? std::string_view(bytes).substr(0, got) : std::string_view{};
    };
    const Result<Sums> sums = parse_sums(text(SnapshotShelf::kSumsMember));
    bool whole = sums.ok() && sums.value().count == files;
    for (int k = 0; whole && k < files; ++k)
        whole = sums.value().all()[static_cast<std::size_t>(k)].sha256.view() ==
                hex_of(sha256_of(std::as_bytes(std::span(text(k))))).data();
    return whole;
}

/// How many snapshots a host sees on a card in this state; none: it sees half of one.
std::optional<int> seen_on(CardState state)
{
    CrashMedium card(std::move(state));
    alignas(64) static std::byte memory[32'768];
    const SnapshotShelf::Limits limits{16, 8};
    EXPECT_LE(SnapshotShelf::bytes_for(limits), sizeof memory);
    SnapshotShelf shelf(card, limits, memory, [] { return std::int64_t{0}; });
    EXPECT_TRUE(shelf.refresh([](const auto&) {}).ok());
    int count = 0;
    bool whole = true;
    shelf.snapshots(1, [&](const SnapshotName& name, int files) {
        whole = whole && is_whole(shelf, name.sequence, files);
        return ++count, true;
    });
    return whole && shelf.hidden().damaged == 0 ? std::optional{count} : std::nullopt;
}

/// Two snapshots and a miss; one of them pulled, and pruned.
void write_story(CrashMedium& card)
{
    const auto store = Store::open(card, {.reserve_bytes = 0, .prune = Prune::kAll, .cause = {}}, ":memory:").value();
    ASSERT_TRUE(store_one(*store, kNoon, std::string(5000, 'c')).ok());
    ASSERT_TRUE(miss_one(*store, kNoon + kSecond, "no camera").ok());
    ASSERT_TRUE(store->mark_pulled(std::vector<Pull>{{1, rows_of(store->catalogue())[0].sums, kNoon}}).ok());
    ASSERT_TRUE(store_one(*store, kNoon + kDay).ok());
    ASSERT_TRUE(store->prune({.free_bytes = 0, .older_than_us = kNoon + 1, .dry_run = false}, [](auto&) {}).ok());
}

TEST(ShelfOnCrashedCard, NothingIsHalfSeenAtAnyMomentOfTheWritersNorAfterThePowerWent)
{
    CrashMedium card;
    write_story(card);
    std::set<int> counts;
    for (std::size_t at = 0; at <= card.log().size(); ++at) {
        for (const Cut::Mode mode : {Cut::Mode::kInOrder, Cut::Mode::kSubset, Cut::Mode::kTorn})
            for (unsigned seed = 1; seed <= (mode == Cut::Mode::kInOrder ? 1U : 5U); ++seed) {
                const Cut cut{mode, at, seed};
                const std::optional<int> seen = seen_on(surviving(card.start(), card.log(), cut));
                EXPECT_TRUE(seen) << cut.text();
                counts.insert(seen.value_or(-1));
            }
    }
    EXPECT_EQ(counts, (std::set<int>{0, 1, 2, 3}));
}

TEST(ShelfOnCrashedCard, HalfOfOneIsSeenWhereTheStoreSyncsNothing)
{
    CrashMedium card;
    write_story(card);
    std::vector<Change> log = card.log();
    for (Change& change : log)
        if (change.kind == Change::Kind::kSyncAll || change.kind == Change::Kind::kSyncFolder)
            change.kind = Change::Kind::kNothing;
    int halves = 0;
    for (unsigned seed = 1; seed <= 50; ++seed)
        halves += seen_on(surviving(card.start(), log, {Cut::Mode::kSubset, log.size(), seed})) ? 0 : 1;
    EXPECT_GT(halves, 0) << "this test's eyes see nothing";
}

} // namespace
} // namespace dicot::test
