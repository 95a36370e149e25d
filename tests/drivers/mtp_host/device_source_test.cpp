// What the puller sees of a board of ours, and of devices that only hold a board's folder.
#include "pull/device_source.h"

#include "labyrinth.h"
#include "responder_pipe.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>

namespace dicot::app {
namespace {

/// More than is read at once.
constexpr std::size_t kCloudBytes = mtp::Initiator::kPieceBytes + 50'000;

constexpr mtp::Initiator::Patience kNoPatience{1000, 0, 0};
constexpr std::int64_t kNoonUs = 1'780'315'200'000'000; // 2026-06-01T12:00:00Z

class OnTheCable : public testing::Test
{
protected:
    OnTheCable()
    {
        listed_.port = "1-1.4";
        listed_.serial = "S7";
    }
    /// A snapshot at noon of the first of June, its number's hour later; files with sizes.
    void snapshot(mtp::Handle day, mtp::Handle handle, std::string_view name)
    {
        shelf_.folder(handle, day, name);
        shelf_.file(handle + 1, handle, "cloud.drc", kCloudBytes);
        shelf_.file(handle + 2, handle, "record.json", 500);
        shelf_.file(handle + 15, handle, "SHA256SUMS", 160);
    }
    PullSources open(bool disguised)
    {
        auto pipe = std::make_unique<test::ResponderPipe>(shelf_);
        pipe->disguised = disguised;
        pipe_ = pipe.get();
        Result<PullSources> sources = sources_behind(std::move(pipe), listed_, kNoPatience);
        EXPECT_TRUE(sources.ok()) << sources.status().message();
        return sources.ok() ? std::move(sources).value() : PullSources{};
    }
    static std::vector<OfferedSnapshot> offers_of(PullSource& source, std::int64_t first = 1)
    {
        std::vector<OfferedSnapshot> offers;
        const Status listed = source.snapshots(first, [&](const OfferedSnapshot& offer) {
            offers.push_back(offer);
            return true;
        });
        EXPECT_TRUE(listed.ok()) << listed.message();
        return offers;
    }
    static std::vector<OfferedFile> files_of(PullSource& source, const OfferedSnapshot& offer)
    {
        std::vector<OfferedFile> files;
        const Status listed = source.files(offer, [&](const OfferedFile& file) {
            files.push_back(file);
            return true;
        });
        EXPECT_TRUE(listed.ok()) << listed.message();
        return files;
    }

    test::MemoryShelf shelf_;
    mtp::MtpListed listed_;
    test::ResponderPipe* pipe_ = nullptr;
};

TEST_F(OnTheCable, ABoardOfOursListsReadsAndTakesMarks)
{
    shelf_.folder(1, 0, "bench-3");
    shelf_.folder(2, 1, "2026-06-01");
    snapshot(2, 0x110, "000017_20260601T120000Z");
    mtp::SnapshotNote note;
    note.sequence = 17;
    note.began_us = kNoonUs;
    note.bytes = kCloudBytes + 660;
    note.folder = 0x110;
    note.files = 3;
    note.sums.fill(std::byte{7});
    shelf_.notes = {note};
    const PullSources sources = open(false);
    ASSERT_EQ(sources.size(), 1u);
    PullSource& board = *sources[0];
    EXPECT_EQ(board.device(), "bench-3");
    EXPECT_EQ(board.serial(), "S7");
    EXPECT_EQ(board.where(), "USB 1-1.4");

    const std::vector<OfferedSnapshot> offers = offers_of(board);
    ASSERT_EQ(offers.size(), 1u);
    EXPECT_EQ(offers[0].sequence, 17);
    EXPECT_EQ(offers[0].began_us, kNoonUs);
    EXPECT_EQ(offers[0].bytes, kCloudBytes + 660);
    EXPECT_EQ(offers[0].sums, note.sums);
    EXPECT_TRUE(offers_of(board, 18).empty());

    const std::vector<OfferedFile> files = files_of(board, offers[0]);
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[0].name.view(), "cloud.drc");
    std::vector<std::byte> room(kCloudBytes - 1000);
    ASSERT_EQ(board.read(files[0], 100, room).value(), room.size());
    EXPECT_EQ(room, test::MemoryShelf::content(0x111, 100, room.size()));
    ASSERT_EQ(board.read(files[0], kCloudBytes - 1, room).value(), 1u);
    EXPECT_EQ(room[0], test::MemoryShelf::content(0x111, kCloudBytes - 1));

    const PullSource::Pulled pulled{17, note.sums};
    ASSERT_TRUE(board.mark({&pulled, 1}).ok());
    ASSERT_EQ(shelf_.marked.size(), 1u);
    EXPECT_EQ(shelf_.marked[0].sums, note.sums);
    ASSERT_TRUE(board.offer_time(kNoonUs).ok());
    EXPECT_EQ(shelf_.offered.at(0).now_us, kNoonUs);

    shelf_.remove(0x110);
    EXPECT_EQ(board.files(offers[0], [](const OfferedFile&) { return true; }).fault(), Fault::kNoInput);
}

TEST_F(OnTheCable, OtherDevicesAreWalkedForFoldersOfTheLayout)
{
    shelf_.folder(1, 0, "DCIM");
    shelf_.folder(2, 0, "home");
    shelf_.folder(3, 2, "clouds");
    shelf_.folder(10, 3, "bench-3");
    shelf_.folder(11, 10, "2026-06-02");
    shelf_.folder(12, 10, "2026-06-01");
    shelf_.folder(13, 10, "incoming");
    snapshot(11, 0x100, "000003_20260602T120000Z");
    snapshot(12, 0x200, "000017_20260601T120000Z"); // its clock went back
    snapshot(12, 0x300, "000018_20260602T120000Z"); // not of that day
    snapshot(13, 0x400, "000019_20260601T130000Z");
    shelf_.file(0x500, 12, "000020_20260601T120000Z", 5);
    shelf_.file(0x205, 0x200, "PULLED", 90);
    shelf_.file(0x206, 0x200, "._cloud.drc", 4096);
    shelf_.folder(0x207, 0x200, "notes");
    shelf_.folder(20, 0, "bench-4");
    shelf_.folder(21, 20, "2026-06-01");
    snapshot(21, 0x600, "000001_20260601T120000Z");

    const PullSources sources = open(true);
    ASSERT_EQ(sources.size(), 2u);
    EXPECT_EQ(sources[0]->device(), "bench-4"); // nearer to the top
    PullSource& board = *sources[1];
    EXPECT_EQ(board.device(), "bench-3");
    const std::vector<OfferedSnapshot> offers = offers_of(board);
    ASSERT_EQ(offers.size(), 2u);
    EXPECT_EQ(offers[0].sequence, 3);
    EXPECT_EQ(offers[1].sequence, 17);
    EXPECT_EQ(offers[1].began_us, kNoonUs);
    EXPECT_FALSE(offers[1].sums);
    ASSERT_EQ(offers_of(board, 4).size(), 1u);
    const std::vector<OfferedFile> files = files_of(board, offers[1]);
    ASSERT_EQ(files.size(), 3u); // neither the mark nor what others left there
    EXPECT_EQ(files[2].name.view(), "SHA256SUMS");
    std::array<std::byte, 16> room{};
    ASSERT_EQ(board.read(files[0], 5, room).value(), 16u);
    EXPECT_EQ(room[0], test::MemoryShelf::content(0x201, 5));
    EXPECT_EQ(board.mark({}).fault(), Fault::kUsage);
    EXPECT_EQ(board.offer_time(kNoonUs).fault(), Fault::kUsage);
}

TEST_F(OnTheCable, ADayWithoutSnapshotsHidesNoBoard)
{
    shelf_.folder(5, 0, "good");
    shelf_.folder(6, 5, "2026-05-31");
    shelf_.folder(7, 5, "2026-06-01");
    snapshot(7, 0x300, "000003_20260601T120000Z");
    EXPECT_EQ(open(true).size(), 1u);
}

TEST_F(OnTheCable, NamesThatLeadElsewhereAreNotFollowed)
{
    shelf_.folder(1, 0, "..");
    shelf_.folder(2, 1, "2026-06-01");
    snapshot(2, 0x100, "000003_20260601T120000Z");
    shelf_.folder(3, 0, "a/b");
    shelf_.folder(4, 3, "2026-06-01");
    snapshot(4, 0x200, "000003_20260601T120000Z");
    EXPECT_TRUE(open(true).empty());
    shelf_.folder(5, 0, "good");
    shelf_.folder(6, 5, "2026-06-01");
    snapshot(6, 0x300, "000003_20260601T120000Z");
    shelf_.file(0x304, 0x300, "../record.json", 5);
    shelf_.file(0x305, 0x300, "/etc/passwd", 5);
    const PullSources sources = open(true);
    ASSERT_EQ(sources.size(), 1u);
    EXPECT_EQ(files_of(*sources[0], offers_of(*sources[0]).at(0)).size(), 3u);
}

TEST_F(OnTheCable, ASnapshotWithMoreFilesThanAStoreHasIsNone)
{
    shelf_.folder(5, 0, "good");
    shelf_.folder(6, 5, "2026-06-01");
    snapshot(6, 0x300, "000003_20260601T120000Z");
    for (mtp::Handle more = 4; more < 10; ++more)
        shelf_.file(0x300 + more, 0x300, "file" + std::to_string(more), 5);
    PullSources sources = open(true);
    ASSERT_EQ(sources.size(), 1u);
    EXPECT_EQ(files_of(*sources[0], offers_of(*sources[0]).at(0)).size(), 9u);
    shelf_.file(0x30E, 0x300, "onemore", 5);
    const OfferedSnapshot offer = offers_of(*sources[0]).at(0);
    EXPECT_EQ(sources[0]->files(offer, [](const OfferedFile&) { return true; }).fault(), Fault::kBadData);
    shelf_.remove(0x30E);
    shelf_.file(0x309, 0x300, "cloud.drc", 5); // a second one
    EXPECT_EQ(sources[0]->files(offer, [](const OfferedFile&) { return true; }).fault(), Fault::kBadData);
}

TEST_F(OnTheCable, ACableThatIsPulledIsSaidToBePulledAtEveryStep)
{
    shelf_.folder(5, 0, "good");
    shelf_.folder(6, 5, "2026-06-01");
    snapshot(6, 0x300, "000003_20260601T120000Z");
    std::vector<std::byte> room(kCloudBytes);
    const auto pull = [&](PullSource& source) -> Status {
        OfferedSnapshot offer;
        OfferedFile cloud;
        TRY(source.snapshots(1, [&](const OfferedSnapshot& one) { return offer = one, true; }));
        TRY(source.files(offer, [&](const OfferedFile& one) { return cloud = one, false; }));
        return source.read(cloud, 0, room).status();
    };
    int unplugged = 0;
    for (int at = 0;; ++at) {
        ASSERT_LT(at, 200);
        const PullSources sources = open(true);
        ASSERT_EQ(sources.size(), 1u);
        pipe_->unplug_at_receive = at;
        const Status pulled = pull(*sources[0]);
        if (pulled.ok())
            break;
        ++unplugged;
        EXPECT_EQ(pulled.fault(), Fault::kUnavailable) << at << ": " << pulled.message();
    }
    EXPECT_GT(unplugged, 15);
}

TEST_F(OnTheCable, ADeviceWhoseHandlesChangeWithTheSessionIsReadOnByNames)
{
    const auto fill = [&](mtp::Handle base) {
        shelf_ = {};
        shelf_.folder(base + 1, 0, "home");
        shelf_.folder(base + 5, base + 1, "good");
        shelf_.folder(base + 6, base + 5, "2026-06-01");
        shelf_.folder(base + 7, base + 6, "000003_20260601T120000Z");
        shelf_.file(0xC10D, base + 7, "cloud.drc",
                    kCloudBytes); // what is in it follows from its handle: this one stays
        shelf_.file(base + 9, base + 7, "record.json", 500);
        shelf_.file(base + 10, base + 7, "SHA256SUMS", 160);
    };
    int broken = 0;
    for (int at = 0; at <= broken; ++at) { // until it comes too late
        ASSERT_LT(at, 200);
        fill(0x100);
        const PullSources sources = open(true);
        ASSERT_EQ(sources.size(), 1u);
        pipe_->when_reset = [&] {
            ++broken;
            fill(0x200);
        };
        pipe_->break_at_receive = at;
        const std::vector<OfferedSnapshot> offers = offers_of(*sources[0]);
        ASSERT_EQ(offers.size(), 1u) << at;
        const std::vector<OfferedFile> files = files_of(*sources[0], offers[0]);
        ASSERT_EQ(files.size(), 3u) << at;
        for (const OfferedFile& file : files) {
            std::vector<std::byte> room(kCloudBytes + 1);
            const Result<std::size_t> got = sources[0]->read(file, 0, room);
            ASSERT_TRUE(got.ok()) << at << ": " << got.status().message();
            EXPECT_EQ(got.value(), file.bytes);
            if (file.name.view() != "cloud.drc")
                continue;
            room.resize(got.value());
            EXPECT_EQ(room, test::MemoryShelf::content(0xC10D, 0, room.size())) << at;
        }
    }
    EXPECT_GT(broken, 20);
}

TEST(PullFromADevice, ATreeThatStandsInItselfIsWalkedOnce)
{
    int asked = 0;
    const Result<PullSources> sources = sources_behind(std::make_unique<test::Labyrinth>(asked), {}, kNoPatience);
    ASSERT_TRUE(sources.ok()) << sources.status().message();
    EXPECT_TRUE(sources.value().empty());
    EXPECT_GT(asked, 20);
    EXPECT_LT(asked, 60); // six folders, five of them in each
}

} // namespace
} // namespace dicot::app
