#include "row_work.h"

#include <algorithm>

namespace dicot::matching {

void RowWork::run(Crew& crew)
{
    for (Station& each : bench_.stations)
        each.times = {};
    if (options_.method == MatchMethod::kBest)
        match_chunks(crew);
    else
        crew.run(workers_, [&](int worker) { match_bands(worker); });
}

void RowWork::select(int y, Station& station, AggregatedRow costs)
{
    const auto width = static_cast<std::size_t>(bench_.scene.width);
    SelectedRow row{{bench_.maps.disparity.row(y), width},
                    {bench_.maps.confidence.row(y), width},
                    {bench_.maps.verdict.row(y), width}};
    station.selector.select(bench_.scene, costs, options_.method != MatchMethod::kPaper, row);
    const int done = rows_done_.fetch_add(1, std::memory_order_relaxed) + 1;
    if (hooks_.rows_done)
        hooks_.rows_done(hooks_.context, done, bench_.scene.height);
}

void RowWork::match_bands(int worker)
{
    const Scene& scene = bench_.scene;
    Station& mine = station(worker);
    const int rows = options_.band_rows > 0 ? options_.band_rows : (scene.height + workers_ - 1) / workers_;
    for (int top = worker * rows; top < scene.height; top += workers_ * rows) {
        mine.costs.restart();
        mine.fast.restart();
        for (int y = top; y < std::min(top + rows, scene.height); ++y) {
            const AggregatedRow costs = options_.method == MatchMethod::kFast
                                            ? mine.fast.row(scene, y, mine.times, hooks_.now_ns)
                                            : mine.costs.row(scene, y, mine.times, hooks_.now_ns);
            const std::uint64_t since = clock();
            if (options_.method != MatchMethod::kPaper)
                mine.scanline.smooth(scene, y, costs, false);
            select(y, mine, costs);
            mine.times.select += clock() - since;
        }
    }
}

void RowWork::match_chunks(Crew& crew)
{
    const Scene& scene = bench_.scene;
    ColumnPaths& paths = bench_.paths;
    crew.run(workers_, [&](int worker) { station(worker).costs.clear(); });
    bench_.raw.clear();
    int made = 0;
    int raw_made = 0;
    for (int chunk = 0; chunk * ColumnPaths::kChunk < scene.height; ++chunk) {
        const int end = paths.end_of_costs(scene, chunk);
        const int raw_end = std::min(end + scene.radius, scene.height);
        crew.run(workers_, [&](int worker) {
            const std::uint64_t since = clock();
            for (int y = raw_made; y < raw_end; ++y)
                if (y / 2 % workers_ == worker)
                    bench_.raw.make(scene, y);
            station(worker).times.cost += clock() - since;
        });
        raw_made = raw_end;
        crew.run(workers_, [&](int worker) {
            Station& mine = station(worker);
            for (int y = made + worker; y < end; y += workers_) {
                const AggregatedRow costs = mine.costs.row(scene, y, mine.times, hooks_.now_ns);
                const std::uint64_t since = clock();
                mine.scanline.smooth(scene, y, costs, true);
                mine.times.select += clock() - since;
                std::ranges::copy(costs, paths.costs(scene, y).begin());
            }
        });
        made = end;
        const auto timed = [&](auto&& step) {
            crew.run(workers_, [&](int worker) {
                const std::uint64_t since = clock();
                step(worker);
                station(worker).times.select += clock() - since;
            });
        };
        timed([&](int worker) { paths.walk(scene, chunk, worker, workers_); });
        timed([&](int worker) {
            Station& mine = station(worker);
            const int top = chunk * ColumnPaths::kChunk;
            for (int y = top + worker; y < std::min(top + ColumnPaths::kChunk, scene.height); y += workers_)
                select(y, mine, paths.costs(scene, y));
        });
    }
}

} // namespace dicot::matching
