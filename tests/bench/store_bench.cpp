// Thousands of small snapshots through the store, on a real disk: whether time and memory stay flat.
//
//   store_bench FOLDER COUNT [--svg FILE] [--program dicot]
//
// FOLDER is made, and stays. Ends with 1 when memory grew, or an answer took too long.
#include "store_plot.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/medium/disk_medium.h"
#include "dicot/os/clock.h"
#include "dicot/os/process_memory.h"
#include "dicot/record/record.h"
#include "dicot/store/store.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

namespace dicot::bench {
namespace {

constexpr int kMostInBlock = 500;
constexpr double kMiB = 1 << 20;
constexpr double kMostGrowthMiB = 0.5; ///< of the whole process, from the first block to the last
constexpr double kMostHeapMiB = 0.5;   ///< of SQLite
constexpr double kMostListMs = 100;
constexpr double kMostSlower = 3; ///< processor time of a snapshot, the last block against the first
constexpr std::int64_t kFirstUs = 1'780'272'000'000'000; // 2026-06-01
constexpr std::int64_t kStepUs = 600'000'000;

struct Words
{
    std::string folder, svg, program;
    int count = 0;
};

double ms_since(std::int64_t start_us)
{
    return static_cast<double>(monotonic_us() - start_us) * 1e-3;
}

double at_part(std::vector<double>& values, double part)
{
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

Status add_bytes(Store& store, const char* name, std::span<const std::byte> bytes)
{
    return store.add(name, [&](ByteSink& sink) { return sink.write(bytes); });
}

/// Small files, none like another.
Status store_one(Store& store, std::int64_t began_us, double& commit_ms)
{
    TRY(store.begin({began_us, began_us}));
    TRY(store.make_room());
    RecordFacts facts;
    facts.sequence = store.sequence();
    facts.began_us = began_us;
    facts.due_us = began_us;
    facts.done = true;
    facts.clock_trust = "network";
    facts.points = 1000 + store.sequence();
    std::byte bytes[4096];
    for (std::size_t i = 0; i < sizeof bytes; ++i)
        bytes[i] = static_cast<std::byte>((static_cast<std::size_t>(store.sequence()) + i) * 2654435761U >> 24);
    TRY(add_bytes(store, "cloud.drc", bytes));
    TRY(add_bytes(store, "left.jpg", std::span{bytes}.first(2048)));
    char text[kMaxPlainRecordBytes];
    const std::size_t size = write_plain_record(facts, "store_bench", text);
    TRY(add_bytes(store, "record.json", std::as_bytes(std::span{text, size})));
    const std::int64_t start = monotonic_us();
    TRY(store.commit({true, {}, facts.clock_trust, facts.points}));
    commit_ms = ms_since(start);
    return {};
}

Result<StoreBlock> store_block(Store& store, int first, int last)
{
    std::vector<double> commits(static_cast<std::size_t>(last - first));
    std::vector<double> processor(commits.size());
    for (int i = first; i < last; ++i) {
        const auto at = static_cast<std::size_t>(i - first);
        const std::int64_t cpu_us = process_cpu_us();
        TRY(store_one(store, kFirstUs + i * kStepUs, commits[at]));
        processor[at] = static_cast<double>(process_cpu_us() - cpu_us) * 1e-3;
    }
    StoreBlock block;
    block.last = last;
    block.commit_median_ms = at_part(commits, 0.5);
    block.commit_p99_ms = at_part(commits, 0.99);
    block.cpu_median_ms = at_part(processor, 0.5);
    block.resident_mib = static_cast<double>(TRY(process_memory()).resident_bytes) / kMiB;
    block.heap_mib = static_cast<double>(Catalogue::peak_heap_bytes()) / kMiB;
    return block;
}

/// Milliseconds until the store is open, and what had to be mended.
Status time_open(const std::string& folder, const char* what)
{
    const std::unique_ptr<Medium> medium = TRY(open_disk_medium(folder));
    const std::int64_t start = monotonic_us();
    const std::unique_ptr<Store> store = TRY(Store::open(*medium, {}, folder + "/" + Store::kCatalogueName));
    std::printf("opened %s: %.1f ms, %d rows added\n", what, ms_since(start), store->start_report().rows_added);
    return {};
}

/// What a person at the board waits for; the best of five.
Result<double> time_list(const Words& words)
{
    const std::string line = "'" + words.program + "' list --store '" + words.folder + "' >/dev/null";
    double best = 1e9;
    for (int i = 0; i < 5; ++i) {
        const std::int64_t start = monotonic_us();
        if (std::system(line.c_str()) != 0)
            return failure(Fault::kSoftware, "%s failed", line.c_str());
        best = std::min(best, ms_since(start));
    }
    return best;
}

Result<bool> run(const Words& words)
{
    const std::string folder = words.folder + "/bench";
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    std::vector<StoreBlock> blocks;
    {
        const std::unique_ptr<Medium> medium = TRY(open_disk_medium(folder));
        const std::unique_ptr<Store> store = TRY(Store::open(*medium, {}, folder + "/" + Store::kCatalogueName));
        std::printf("snapshots  commit ms: median     p99   processor ms  resident MiB  SQLite MiB\n");
        const int together = std::clamp(words.count / 4, 1, kMostInBlock);
        for (int done = 0; done < words.count; done += together) {
            blocks.push_back(TRY(store_block(*store, done, std::min(words.count, done + together))));
            const StoreBlock& block = blocks.back();
            std::printf("%9d %18.2f %7.2f %14.2f %13.2f %11.2f\n", block.last, block.commit_median_ms,
                        block.commit_p99_ms, block.cpu_median_ms, block.resident_mib, block.heap_mib);
            std::fflush(stdout);
        }
    }
    TRY(time_open(folder, "as it was left"));
    std::fclose(std::fopen((folder + "/writing").c_str(), "w"));
    TRY(time_open(folder, "after an interruption"));
    std::filesystem::remove(folder + "/" + Store::kCatalogueName, error);
    TRY(time_open(folder, "without its catalogue"));
    if (!words.svg.empty())
        TRY(write_store_plot(words.svg, std::to_string(words.count) + " small snapshots, one after the other", blocks));

    bool flat = true;
    const double growth = blocks.back().resident_mib - blocks.front().resident_mib;
    std::printf("memory grew by %.2f MiB (%.2f are allowed)\n", growth, kMostGrowthMiB);
    flat = growth <= kMostGrowthMiB && blocks.back().heap_mib <= kMostHeapMiB;
    const double slower = blocks.back().cpu_median_ms / std::max(blocks.front().cpu_median_ms, 0.01);
    std::printf("processor time is %.2f times that of the first (%.0f are allowed)\n", slower, kMostSlower);
    flat = flat && slower <= kMostSlower;
    if (!words.program.empty()) {
        const double list_ms = TRY(time_list(words));
        std::printf("dicot list: %.1f ms (%.0f are allowed)\n", list_ms, kMostListMs);
        flat = flat && list_ms <= kMostListMs;
    }
    return flat;
}

} // namespace
} // namespace dicot::bench

int main(int argc, char** argv)
{
    dicot::bench::Words words;
    if (argc >= 3) {
        words.folder = argv[1];
        words.count = std::atoi(argv[2]);
    }
    for (int i = 3; i + 1 < argc; i += 2)
        (std::strcmp(argv[i], "--svg") == 0 ? words.svg : words.program) = argv[i + 1];
    if (words.count <= 0) {
        std::fprintf(stderr, "usage: %s FOLDER COUNT [--svg FILE] [--program dicot]\n", argv[0]);
        return 64;
    }
    const dicot::Result<bool> flat = dicot::bench::run(words);
    if (!flat.ok())
        std::fprintf(stderr, "%s\n", flat.status().message());
    return flat.ok() && flat.value() ? 0 : 1;
}
