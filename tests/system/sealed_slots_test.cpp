// Slot after slot behind the sealed heap: nothing is taken that was not there at the start.
#include "flat_pair.h"

#include "health/health_record.h"
#include "run/run_memory.h"
#include "snapshot.h"
#include "store/board_store.h"

#include "dicot/os/clock_trust.h"
#include "dicot/os/input_file.h"
#include "dicot/os/process_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <malloc.h>
#include <unistd.h>

namespace dicot {
namespace {

constexpr std::int64_t kHourUs = 3'600'000'000;
constexpr std::int64_t kJuneUs = 1'780'272'000'000'000; // 2026-06-01

/// What may befall a camera, and whether a snapshot comes out all the same.
struct Fate
{
    const char* script;
    bool done;
};
constexpr std::array kFates{
    Fate{"", true},
    Fate{"drop 4", true},
    Fate{"torn 3; torn 5", true},
    Fate{"hang 4 restart", true},
    Fate{"gone 3 reopen", true},
    Fate{"full 1", true},
    Fate{"hang 2", false},
    Fate{"gone 4", false},
    Fate{"full 100", false},
};

std::int64_t resident_now()
{
    InputFile file;
    std::array<char, 2048> text{};
    if (!file.open("/proc/self/smaps_rollup").ok() ||
        !file.read(std::as_writable_bytes(std::span{text}).first(text.size() - 1)).ok())
        return -1;
    const char* const found = std::strstr(text.data(), "\nRss:");
    return found == nullptr ? -1 : std::strtoll(found + 5, nullptr, 10) * 1024;
}

/// What the C library's own heap has of the system.
std::size_t systems_heap()
{
    const struct mallinfo2 told = ::mallinfo2();
    return told.arena + told.hblkhd;
}

std::size_t address_space()
{
    const auto told = process_memory();
    return told.ok() ? static_cast<std::size_t>(told.value().address_bytes) : 0;
}

int slots_wanted()
{
    const char* const told = std::getenv("DICOT_SLOTS");
    return told == nullptr ? 300 : std::max(std::atoi(told), 100);
}

/// Between two slots.
struct Rest
{
    std::int64_t resident = 0;
    std::size_t office = 0, libraries = 0, pages = 0, address = 0;
};

class SealedSlots : public testing::Test
{
protected:
    void SetUp() override
    {
        // What is synced at every slot need not reach a disk here.
        if (::access("/dev/shm", W_OK) == 0)
            ::setenv("TMPDIR", "/dev/shm", 1);
    }
};

TEST_F(SealedSlots, TakeNothingOutsideTheArenasWhateverBefallsTheCameras)
{
    if (!heap_gate::replaces_operator_new()) {
        std::printf("NOT RUN: SealedSlots: a sanitizer brings its own malloc\n");
        return;
    }
    const int slots = slots_wanted();
    const test::TempFolder folder;
    const std::string file = test::FlatPair{}.write(folder, 500, 3000);
    const app::LoadedConfig loaded = app::load_config(file).value();
    std::vector<app::Config> configs(kFates.size(), loaded.config);
    for (std::size_t i = 0; i < kFates.size(); ++i)
        configs[i].cameras.replay_script_left = kFates[i].script;

    app::RunMemory::keep_address_space_known();
    const app::BareProcess bare = app::BareProcess::measure().value();
    const auto bench = app::SnapshotBench::make(loaded.config);
    ASSERT_TRUE(bench.ok()) << bench.status().message();
    const app::CameraMemory cameras = app::CameraMemory::measure(loaded.config).value();
    const app::RunBudget budget =
        app::run_budget(loaded.config, bare, cameras, bench.value()->work->budget(), bench.value()->plan.threads)
            .value();
    const app::BoardStore board = app::BoardStore::make(loaded.config.output, "").value();
    ASSERT_TRUE(board.open_patiently({}).ok());
    app::SnapshotWords how;
    how.device = board.device;
    std::vector<Rest> rests(static_cast<std::size_t>(slots));
    std::vector<int> wrong; // numbers of the slots that did not end as they should
    wrong.reserve(static_cast<std::size_t>(slots));
    app::HealthHistory history;
    std::size_t heap_before = 0;
    std::size_t heap_after = 0;
    app::RunMemoryFigures told;
    {
        const auto memory = app::RunMemory::carve(budget).value();
        memory->seal(heap_gate::Breach::kCount);
        heap_before = systems_heap();
        for (int slot = 0; slot < slots; ++slot) {
            const std::size_t fate = static_cast<std::size_t>(slot) % kFates.size();
            bool done = false;
            bool stored = false;
            how.raw = slot % 2 == 0;
            how.preview = slot % 10 == 0;
            ClockReading clock;
            clock.now_us = kJuneUs + slot * kHourUs;
            const Status status = memory->safely([&]() -> Status {
                const auto opened = TRY(board.open_patiently({.reserve_bytes = 0, .prune = Prune::kAll}));
                how.card = app::card_health(*opened.medium, opened.store->catalogue(), 0);
                const auto shot = TRY(app::take_snapshot(configs[fate], how, bench, clock, history, *opened.store));
                done = shot.status.ok();
                stored = shot.stored;
                return {};
            });
            if (!status.ok() || !stored || done != kFates[fate].done)
                wrong.push_back(slot);
            const auto now = memory->figures();
            rests[static_cast<std::size_t>(slot)] = {resident_now(), now.office_used_bytes, now.libraries_used_bytes,
                                                     now.pages_used_bytes, address_space()};
        }
        heap_after = systems_heap();
        told = memory->figures();
    }

    EXPECT_EQ(wrong, std::vector<int>{}) << "of " << kFates.size() << " fates in turn";
    EXPECT_EQ(told.breaches, 0U);
    EXPECT_EQ(told.office_refused, 0U);
    EXPECT_EQ(told.library_refused, 0U);
    EXPECT_EQ(told.pages_refused, 0U);
    EXPECT_LE(heap_after, heap_before) << "the C library's heap grew behind the gate";
    EXPECT_GT(told.libraries_served, static_cast<std::uint64_t>(slots)) << "libjpeg asks malloc at every slot";

    // Once each fate has been met.
    const auto warm = rests.begin() + 2 * static_cast<std::ptrdiff_t>(kFates.size());
    const Rest& first = *warm;
    for (auto rest = warm; rest != rests.end(); ++rest) {
        ASSERT_EQ(rest->office, first.office) << "bytes stay behind in the office at slot " << rest - rests.begin();
        ASSERT_EQ(rest->libraries, first.libraries) << rest - rests.begin();
        ASSERT_EQ(rest->pages, 0U) << rest - rests.begin();
        ASSERT_EQ(rest->address, first.address) << rest - rests.begin();
    }
    const auto resident = [](const Rest& a, const Rest& b) { return a.resident < b.resident; };
    const auto half = rests.begin() + slots / 2;
    const std::int64_t early = std::max_element(rests.begin(), half, resident)->resident;
    const std::int64_t late = std::max_element(half, rests.end(), resident)->resident;
    EXPECT_GT(early, 0);
    EXPECT_LE(late, early + 128 * 1024) << "resident memory is not flat"; // SQLite's pages of a growing catalogue
    std::printf(
        "%d slots: resident at most %.2f MiB in the first half, %.2f in the second, budget %.2f; office %zu KiB "
        "of %zu, malloc %zu KiB of %zu in %llu calls, pages %zu KiB of %zu; heap of the system %zu -> %zu KiB\n",
        slots, static_cast<double>(early) / (1 << 20), static_cast<double>(late) / (1 << 20),
        static_cast<double>(budget.resident()) / (1 << 20), told.office_peak_bytes / 1024, budget.office.mapped / 1024,
        told.libraries_peak_bytes / 1024, budget.libraries.mapped / 1024,
        static_cast<unsigned long long>(told.libraries_served), told.pages_peak_bytes / 1024, budget.pages / 1024,
        heap_before / 1024, heap_after / 1024);
}

} // namespace
} // namespace dicot
