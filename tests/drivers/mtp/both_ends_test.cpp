// The computer's side and the board's, with memory for a cable: what one says the other understands.
#include "board.h"
#include "responder_pipe.h"

#include "dicot/mtp_host/initiator.h"

namespace dicot {
namespace {

using test::Bytes;
using test::MemoryShelf;
using test::MtpBoard;

class BothEnds : public MtpBoard
{
protected:
    void SetUp() override { ASSERT_TRUE(host.open().ok()); }
    void expect_file(mtp::Handle handle, std::uint64_t bytes, std::uint64_t offset, std::size_t size)
    {
        Bytes into(size);
        const Result<std::size_t> got = host.read(handle, bytes, offset, into);
        ASSERT_TRUE(got.ok()) << got.status().message();
        ASSERT_EQ(got.value(), std::min<std::uint64_t>(size, bytes - offset));
        into.resize(got.value());
        EXPECT_EQ(into, MemoryShelf::content(handle, offset, into.size()));
    }

    test::ResponderPipe pipe{shelf};
    mtp::Initiator host{pipe, {1000, 0, 0}};
};

TEST_F(BothEnds, KnowEachOther)
{
    const mtp::DeviceFacts& facts = host.facts();
    EXPECT_EQ(facts.model.view(), "board");
    EXPECT_EQ(facts.serial.view(), "S7");
    EXPECT_TRUE(facts.lists_snapshots);
    std::vector<std::uint32_t> storages;
    ASSERT_TRUE(host.storages(storages).ok());
    EXPECT_EQ(storages, std::vector<std::uint32_t>{0x00010001});
}

TEST_F(BothEnds, WalkTheTree)
{
    std::vector<std::uint32_t> handles;
    ASSERT_TRUE(host.children(0x00010001, 0, true, handles).ok());
    EXPECT_EQ(handles, std::vector<std::uint32_t>{kBoard});
    ASSERT_TRUE(host.children(0x00010001, kSnapshot, false, handles).ok());
    EXPECT_EQ(handles, (std::vector<std::uint32_t>{kLeft, kCloud, kSums}));
    ASSERT_TRUE(host.children(0x00010001, kDay, true, handles).ok());
    EXPECT_EQ(handles, std::vector<std::uint32_t>{kSnapshot});
    mtp::ObjectFacts facts;
    ASSERT_TRUE(host.object(kCloud, facts).ok());
    EXPECT_EQ(facts.name.view(), "cloud.drc");
    EXPECT_EQ(facts.bytes, 300'000u);
    EXPECT_FALSE(facts.folder);
    EXPECT_FALSE(host.object(0x99, facts).ok());
}

TEST_F(BothEnds, ReadFilesAtAnyPlace)
{
    expect_file(kCloud, 300'000, 0, 300'000);
    expect_file(kCloud, 300'000, 299'000, 4096);
    constexpr std::uint64_t kBytes = 0xFFFF'0000;
    shelf.file(0x73, kSnapshot, "film.bin", kBytes);
    mtp::ObjectFacts facts;
    ASSERT_TRUE(host.object(0x73, facts).ok());
    EXPECT_EQ(facts.bytes, kBytes);
    expect_file(0x73, kBytes, 0xFFF8'0007, 1 << 20);
    for (const std::size_t size : {500u, 512u, 1012u, 131'060u, 131'072u, 1'048'564u, 1'048'576u})
        expect_file(0x73, kBytes, 7, size);
}

TEST_F(BothEnds, FileThatIsPrunedMidwayIsNotThereAndTheNextOneIsRead)
{
    shelf.prune_at = 200'000;
    Bytes into(300'000);
    EXPECT_EQ(host.read(kCloud, 300'000, 0, into).status().fault(), Fault::kNoInput);
    shelf.prune_at = UINT64_MAX;
    expect_file(kLeft, 1000, 0, 1000);
    EXPECT_EQ(pipe.counts().sessions, 1u) << "nobody was reset for it";
}

TEST_F(BothEnds, FileThatCannotBeReadHoldsUpNoOther)
{
    shelf.read_fault = Fault::kIoError;
    shelf.read_fault_at = 200'000;
    Bytes into(300'000);
    EXPECT_EQ(host.read(kCloud, 300'000, 0, into).status().fault(), Fault::kIoError);
    expect_file(kLeft, 1000, 0, 1000);
    EXPECT_EQ(pipe.counts().sessions, 1u) << "nobody was reset for it";
}

TEST_F(BothEnds, ListMarkAndTellTheTime)
{
    for (std::int64_t i = 1; i <= 3000; ++i)
        shelf.notes.push_back({i, kNoonUs + i, 1000, static_cast<std::uint32_t>(i << 4), 3, i % 3 == 0, {}});
    std::vector<mtp::SnapshotNote> all, some;
    do {
        some.clear();
        ASSERT_TRUE(host.list_snapshots(all.empty() ? 0 : all.back().sequence + 1, some).ok());
        all.insert(all.end(), some.begin(), some.end());
    } while (!some.empty());
    EXPECT_EQ(all, shelf.notes);
    std::vector<mtp::PulledNote> marks;
    for (std::int64_t i = 1; i <= 38; ++i) // three whole packets
        marks.push_back({i, all[static_cast<std::size_t>(i)].sums});
    EXPECT_TRUE(host.mark_pulled(marks).ok());
    ASSERT_EQ(shelf.marked.size(), 38u);
    EXPECT_EQ(shelf.marked[37].sequence, 38);
    shelf.mark_fault = Fault::kTryAgain;
    EXPECT_EQ(host.mark_pulled(marks).fault(), Fault::kTryAgain);
    EXPECT_TRUE(host.offer_time({kNoonUs}).ok());
    EXPECT_EQ(shelf.offered.at(0).now_us, kNoonUs);
}

TEST_F(BothEnds, SessionThatWasLeftOpenIsNoHindrance)
{
    mtp::Initiator other{pipe, {1000, 0, 0}};
    EXPECT_TRUE(other.open().ok());
    std::vector<std::uint32_t> storages;
    EXPECT_TRUE(other.storages(storages).ok());
    other.close();
    EXPECT_FALSE(pipe.counts().session_open);
}

} // namespace
} // namespace dicot
