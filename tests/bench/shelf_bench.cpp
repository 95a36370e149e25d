// What hosts are shown of a store of many snapshots: how long it takes, and how much memory.
//
//   shelf_bench STORE
//
// STORE: one board's folder, as store_bench makes it (FOLDER/bench). Ends with 1 when memory grew beyond the index, or
// an answer took too long.
#include "shelf_objects.h"

#include "dicot/os/clock.h"
#include "dicot/os/process_memory.h"

#include <chrono>
#include <cstdio>
#include <thread>

namespace dicot::bench {
namespace {

constexpr double kMiB = 1 << 20;
constexpr double kMostRefreshMs = 50;
constexpr double kMostGrowthMiB = 0.25;

double ms_since(std::int64_t start_us)
{
    return static_cast<double>(monotonic_us() - start_us) * 1e-3;
}

Result<double> resident_mib()
{
    return static_cast<double>(TRY(process_memory()).resident_bytes) / kMiB;
}

struct Walk
{
    std::size_t objects = 0, notes = 0;
    double all_ms = 0, find_ms = 0, notes_ms = 0;
};

Result<Walk> walk(app::ShelfObjects& objects)
{
    Walk walk;
    std::int64_t start = monotonic_us();
    TRY(objects.all([&](mtp::Handle) { return ++walk.objects, true; }));
    walk.all_ms = ms_since(start);
    start = monotonic_us();
    TRY(objects.all([&](mtp::Handle handle) { return objects.find(handle).ok(); }));
    walk.find_ms = ms_since(start);
    start = monotonic_us();
    TRY(objects.snapshots(1, [&](const mtp::SnapshotNote&) { return ++walk.notes, true; }));
    walk.notes_ms = ms_since(start);
    return walk;
}

Result<double> time_refresh(app::ShelfObjects& objects, const char* what)
{
    std::size_t changes = 0;
    const std::int64_t start = monotonic_us();
    TRY(objects.refresh([&](const auto&) { ++changes; }));
    const double ms = ms_since(start);
    std::printf("refreshed, %s: %.2f ms, %zu changes\n", what, ms, changes);
    return ms;
}

Result<bool> run(const char* store)
{
    app::ShelfSettings settings;
    settings.path = store;
    settings.device = "bench";
    const app::ShelfBudget budget = app::shelf_budget(settings.limits);
    std::printf("budget: index %.2f MiB mapped for %zu snapshots, marks: %.2f MiB and SQLite's %.2f\n",
                static_cast<double>(budget.index) / kMiB, settings.limits.snapshots,
                static_cast<double>(budget.office + budget.pages) / kMiB, static_cast<double>(budget.catalogue) / kMiB);
    const double before_mib = TRY(resident_mib());
    const std::int64_t start = monotonic_us();
    const auto objects = TRY(app::ShelfObjects::open(settings));
    std::printf("opened: %.1f ms, %.2f MiB more are resident\n", ms_since(start), TRY(resident_mib()) - before_mib);
    bool good = TRY(time_refresh(*objects, "nothing came")) <= kMostRefreshMs;
    double seen_mib = 0;
    for (const char* const what : {"first time", "again"}) {
        const Walk walked = TRY(walk(*objects));
        std::printf("%s: %zu objects in %.1f ms, each looked at %.1f ms, %zu notes %.1f ms\n", what, walked.objects,
                    walked.all_ms, walked.find_ms, walked.notes, walked.notes_ms);
        const double now_mib = TRY(resident_mib());
        if (seen_mib > 0) {
            std::printf("memory grew by %.2f MiB (%.2f are allowed)\n", now_mib - seen_mib, kMostGrowthMiB);
            good = good && now_mib - seen_mib <= kMostGrowthMiB;
        }
        seen_mib = now_mib;
    }
    constexpr std::int64_t kCoarseUs = 3'500'000; // by then no clock can stand where it stood
    std::this_thread::sleep_for(std::chrono::microseconds(kCoarseUs));
    (void)TRY(time_refresh(*objects, "days listed once more, as their clock may have stood still"));
    good = good && TRY(time_refresh(*objects, "nothing came")) <= kMostRefreshMs;
    return good;
}

} // namespace
} // namespace dicot::bench

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s STORE\n", argv[0]);
        return 64;
    }
    const dicot::Result<bool> good = dicot::bench::run(argv[1]);
    if (!good.ok())
        std::fprintf(stderr, "%s\n", good.status().message());
    return good.ok() && good.value() ? 0 : 1;
}
