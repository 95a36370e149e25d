// A shelf over a card that somebody else wrote to, or that fails.
#include "shelf_scene.h"

#include "card_state.h"

#include <cerrno>
#include <fstream>
#include <functional>

#include <sys/stat.h>

namespace dicot::test {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kDay = 86'400 * kSecond;

/// Fails in the folder `where`, after `entries` of its names.
class Failing final : public PassingMedium
{
public:
    using PassingMedium::PassingMedium;
    Errno list(const char* path, FunctionRef<bool(const MediumEntry&)> visit) override
    {
        if (path != where)
            return PassingMedium::list(path, visit);
        int left = entries;
        (void)PassingMedium::list(path, [&](const MediumEntry& entry) { return left-- > 0 && visit(entry); });
        return EIO;
    }
    Errno open(const char* path, File& file, std::uint64_t& size) override
    {
        return unread == path ? Errno{EIO} : PassingMedium::open(path, file, size);
    }
    Errno read_at(File file, std::uint64_t offset, std::span<std::byte> into, std::size_t& got) override
    {
        const Errno outcome = PassingMedium::read_at(file, offset, into, got);
        return reads_fail ? Errno{EIO} : outcome;
    }
    std::string where = "nowhere", unread;
    int entries = 0;
    bool reads_fail = false;
};

class ShelfDamage : public ShelfScene
{
};

class ShelfOnFailingCard : public ShelfScene
{
protected:
    Failing& open_on_failing_card()
    {
        disk_ = open_disk_medium(root()).value();
        card_ = std::make_unique<Failing>(*disk_);
        open_shelf({64, 16}, card_.get());
        return *card_;
    }

private:
    std::unique_ptr<Medium> disk_;
    std::unique_ptr<Failing> card_;
};

TEST_F(ShelfDamage, NamesThatTheStoreDoesNotMakeAreNotShown)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    ASSERT_TRUE(store_one(store, kNoon + kDay).ok());
    const std::set<std::string> ours = folders_in(root());
    const std::string good = at(name_of({1, kNoon}));
    const std::string day = at("2026-06-01/");
    for (const std::string name :
         {"000003_20260602T120000Z", "00003_20260601T120000Z", "0000003_20260601T120000Z",
          "1000000000_20260601T120000Z", "000003_20260601T126000Z", "000003_20260601T120000Z ",
          "000003_20260601T120000Z.2", "000003_20260601T120000Z_20260601T120000Z", "-00003_20260601T120000Z",
          "000003-20260601T120000Z", "000000_20260601T120000Z", "\n", "..3", "000003_20260601T120000z"})
        fs::copy(good, day + name);
    fs::copy(good, day + std::string(255, '0'));
    std::ofstream(day + "000004_20260601T120000Z") << "a file";
    fs::create_directory_symlink(good, day + "000005_20260601T120000Z");
    ASSERT_EQ(::mkfifo((day + "000006_20260601T120000Z").c_str(), 0600), 0);
    for (const std::string name :
         {"2026-6-1", "2026-02-30", "2026-06-03 ", "20260603", "2026-06-03.old", "+026-06-03"}) {
        fs::create_directory(at(name));
        fs::copy(good, at(name + "/000007_20260603T120000Z"));
    }
    fs::create_directory(at("elsewhere"));
    fs::copy(good, at("elsewhere/000008_20260603T120000Z"));
    fs::create_directory_symlink(at("elsewhere"), at("2026-06-03"));
    std::ofstream(at("2026-06-04")) << "a file";
    // Beyond what handles can hold: told.
    fs::copy(good, day + "134217728_20260601T120000Z");
    fs::create_directory(at("1969-12-31"));
    fs::copy(good, at("1969-12-31/000009_19691231T120000Z"));
    open_shelf();
    EXPECT_EQ(shown(), ours);
    EXPECT_EQ(shelf().hidden().beyond_numbers, 2U);
    EXPECT_EQ(shelf().hidden().damaged, 0U);
    fs::copy(good, day + "134217727_20260601T120000Z");
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(told, std::vector<std::string>{"+2026-06-01/134217727_20260601T120000Z"});
    EXPECT_EQ(shelf().latest_before(kNoon + 10 * kDay), kNoon + kDay);
}

TEST_F(ShelfDamage, OneThatIsDamagedIsPassedOverAndTheOthersAreShown)
{
    const std::vector<std::function<void(const std::string&)>> ways{
        [](const std::string& folder) { fs::remove(folder + "/SHA256SUMS"); },
        [](const std::string& folder) { fs::remove(folder + "/cloud.drc"); },
        [](const std::string& folder) { fs::resize_file(folder + "/SHA256SUMS", 100); },
        [](const std::string& folder) { std::ofstream(folder + "/SHA256SUMS") << std::string(5000, 'x'); },
        [](const std::string& folder) { std::ofstream(folder + "/SHA256SUMS"); },
        [](const std::string& folder) {
            std::ofstream(folder + "/SHA256SUMS", std::ios::app)
                << std::string(64, '0') << "  ../../../../etc/passwd\n";
        },
        [](const std::string& folder) {
            fs::remove(folder + "/left.jpg");
            fs::create_symlink("/etc/passwd", folder + "/left.jpg");
        },
        [](const std::string& folder) {
            fs::remove(folder + "/left.jpg");
            fs::create_directory(folder + "/left.jpg");
        },
        [](const std::string& folder) { fs::resize_file(folder + "/left.jpg", std::uintmax_t{1} << 40); },
    };
    Store& store = open();
    std::set<std::string> whole;
    for (std::size_t k = 0; k < ways.size(); ++k) {
        ASSERT_TRUE(store_one(store, kNoon).ok());
        ways[k](at(store.folder()));
        ASSERT_TRUE(store_one(store, kNoon + kDay).ok());
        whole.insert(store.folder());
    }
    open_shelf();
    EXPECT_EQ(shown(), whole);
    EXPECT_EQ(shelf().hidden().damaged, ways.size());
    EXPECT_FALSE(shelf().has_day(kNoon / kDay)) << "an empty folder";
    EXPECT_FALSE(shelf().find(1));
    EXPECT_EQ(shelf().files(1).status().fault(), Fault::kNoInput);
    // Also one that comes later: nobody hears of it.
    ASSERT_TRUE(store_one(store, kNoon + 2 * kDay).ok());
    fs::remove(at(std::string(store.folder()) + "/SHA256SUMS"));
    ASSERT_TRUE(store_one(store, kNoon + 2 * kDay).ok());
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(told, (std::vector<std::string>{"-2026-06-01", "+2026-06-03", std::string("+") + store.folder()}));
}

TEST_F(ShelfDamage, OneThatIsDamagedAfterItWasShownIsToldToBeGone)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    open_shelf();
    ASSERT_EQ(shown().size(), 1U);
    fs::remove(at(name_of({1, kNoon}) + "/left.jpg"));
    std::size_t got = 0;
    std::byte byte{};
    EXPECT_EQ(shelf().read(1, 1, 0, {&byte, 1}, got).fault(), Fault::kNoInput);
    EXPECT_EQ(shown().size(), 0U);
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(told, (std::vector<std::string>{"-" + name_of({1, kNoon}), "-2026-06-01"}));
    ASSERT_TRUE(refresh().ok());
    EXPECT_TRUE(told.empty());
}

TEST_F(ShelfDamage, OfTwoFoldersWithOneNumberTheFirstIsShownWhateverTheOrderOfTheirComing)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    ASSERT_TRUE(store_one(store, kNoon + kDay).ok());
    const std::string first = name_of({1, kNoon}), second = name_of({2, kNoon + kDay});
    open_shelf();
    fs::copy(at(first), at(name_of({1, kNoon + kDay})));
    fs::copy(at(second), at(name_of({2, kNoon})));
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(told, (std::vector<std::string>{"-" + second, "-2026-06-02", "+" + name_of({2, kNoon})}));
    const std::set<std::string> left{first, name_of({2, kNoon})};
    EXPECT_EQ(shown(), left);
    EXPECT_EQ(shelf().hidden().doubled, 2U);
    open_shelf();
    EXPECT_EQ(shown(), left);
    fs::remove_all(at(first));
    ASSERT_TRUE(refresh().ok());
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(shown(), (std::set<std::string>{name_of({1, kNoon + kDay}), name_of({2, kNoon})}));
}

TEST_F(ShelfOnFailingCard, AListingThatFailsHalfWayChangesNothing)
{
    Store& store = open();
    for (int k = 0; k < 6; ++k)
        ASSERT_TRUE(store_one(store, kNoon + k * kDay / 3).ok());
    Failing& card = open_on_failing_card();
    const std::set<std::string> before = shown();
    ASSERT_EQ(before, folders_in(root()));
    ASSERT_TRUE(store_one(store, kNoon + kSecond).ok());
    ASSERT_TRUE(store_one(store, kNoon + 3 * kDay).ok());
    fs::rename(at(name_of({1, kNoon})), at("quarantine/000001"));
    for (const char* where : {"2026-06-01", "2026-06-04", ""})
        for (int entries = 0; entries < 12; ++entries) {
            card.where = where;
            card.entries = entries;
            const Status status = refresh();
            if (std::string(where).empty()) {
                EXPECT_EQ(status.fault(), Fault::kIoError);
                EXPECT_TRUE(told.empty()) << told.front();
            }
            for (const std::string& change : told)
                EXPECT_EQ(change.find(std::string(where).empty() ? "+" : where), std::string::npos) << change;
        }
    card.where = "nowhere";
    ASSERT_TRUE(refresh().ok());
    EXPECT_EQ(shown(), folders_in(root()));
    EXPECT_EQ(shelf().hidden().unread_days, 0U);
}

TEST_F(ShelfOnFailingCard, WhatCannotBeReadNowIsPassedOverNowAndShownLater)
{
    Store& store = open();
    ASSERT_TRUE(store_one(store, kNoon).ok());
    ASSERT_TRUE(store_one(store, kNoon + kSecond).ok());
    Failing& card = open_on_failing_card();
    card.unread = name_of({1, kNoon}) + "/SHA256SUMS";
    EXPECT_EQ(shown(), std::set<std::string>{name_of({2, kNoon + kSecond})});
    EXPECT_EQ(shelf().files(1).status().fault(), Fault::kIoError);
    card.unread.clear();
    EXPECT_EQ(shown(), folders_in(root()));
    card.reads_fail = true;
    std::size_t got = 1;
    std::byte byte{};
    EXPECT_EQ(shelf().read(1, 0, 0, {&byte, 1}, got).fault(), Fault::kIoError);
    EXPECT_EQ(got, 0U);
    card.reads_fail = false;
    EXPECT_EQ(bytes_at(1, 0), "the points");
}

/// Whatever happens to the folders: what is shown is what is there, and whoever listens knows the same.
TEST_F(ShelfDamage, ListenersKnowWhatIsShownAfterAnyStory)
{
    ASSERT_TRUE(store_one(open(), kNoon).ok());
    close();
    const std::string one = at("quarantine/one");
    fs::rename(at(name_of({1, kNoon})), one);
    fs::remove(at("2026-06-01"));
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Dice dice(seed);
        open_shelf({1000, 16});
        std::set<std::string> known;
        for (const std::string& folder : folders_in(root()))
            known.insert({folder, folder.substr(0, folder.find('/'))});
        for (int step = 1; step <= 60; ++step) {
            const std::set<std::string> there = folders_in(root());
            const int number = static_cast<int>(seed) * 1000 + step;
            if (there.empty() || !dice.one_in(3)) {
                const auto began_us = kNoon + static_cast<std::int64_t>(dice.below(5)) * kDay;
                const std::string folder = at(name_of({number, began_us}));
                fs::copy(one, at("incoming/one"));
                fs::create_directories(fs::path(folder).parent_path());
                fs::rename(at("incoming/one"), folder);
            } else {
                const auto gone =
                    fs::path(at(*std::next(there.begin(), static_cast<std::ptrdiff_t>(dice.below(there.size())))));
                fs::rename(gone, at("leaving/" + std::to_string(number)));
                if (fs::is_empty(gone.parent_path()))
                    fs::remove(gone.parent_path());
            }
            if (dice.one_in(2))
                continue;
            wait();
            ASSERT_TRUE(refresh().ok());
            for (const std::string& change : told)
                ASSERT_TRUE(change[0] == '+' ? known.insert(change.substr(1)).second
                                             : known.erase(change.substr(1)) == 1)
                    << change << ", step " << step;
            std::set<std::string> now = folders_in(root());
            ASSERT_EQ(shown(), now) << step;
            for (const std::string& folder : folders_in(root()))
                now.insert(folder.substr(0, folder.find('/')));
            ASSERT_EQ(known, now) << step;
        }
    }
}

} // namespace
} // namespace dicot::test
