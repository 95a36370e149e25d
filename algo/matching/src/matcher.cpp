#include "dicot/matching/matcher.h"

#include "bench.h"
#include "row_work.h"
#include "slants.h"
#include "speckles.h"
#include "tables.h"
#include "votes.h"

#include <algorithm>
#include <new>

namespace dicot {
namespace matching {

namespace {

/// Of a range so many times smaller is what kBest searches beyond its far end: background has its true partner there
/// and takes no other.
constexpr int kFartherShare = 8;

/// The voters' gamma, in those of the support weights.
constexpr double kVotersGamma = 1.5;

template <typename Pixel>
ImageView<Pixel> take_map(Arena& arena, int width, int height)
{
    const auto pixels = arena.take<Pixel>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return {pixels.data(), width, height};
}

// Fills what it carves, so it must not be called on an arena that is too small.
void lay_out(Bench& bench, Arena& arena, const MatchOptions& options, int workers)
{
    Scene& scene = bench.scene;
    const int window = 2 * scene.radius + 1;
    const auto cells = static_cast<std::size_t>(window * window);
    const bool best = options.method == MatchMethod::kBest;
    const int margin = best ? std::max(scene.radius, SurfaceRefiner::kReach) : scene.radius;
    scene.left_spatial = arena.take<std::uint16_t>(cells);
    scene.right_spatial = arena.take<std::uint16_t>(cells);
    scene.left.lay_out(arena, scene.width, scene.height, margin, margin);
    scene.right.lay_out(arena, scene.width, scene.height, margin + scene.axis - 1, margin);
    bench.maps.disparity = take_map<DispQ8>(arena, scene.width, scene.height);
    bench.maps.confidence = take_map<std::uint8_t>(arena, scene.width, scene.height);
    bench.maps.verdict = take_map<Verdict>(arena, scene.width, scene.height);
    if (options.dense && options.method != MatchMethod::kPaper)
        bench.maps.scratch = take_map<DispQ8>(arena, scene.width, scene.height);
    if (best) {
        bench.columns = arena.take<std::uint8_t>(static_cast<std::size_t>(scene.width));
        // What follows the rows works where their tables were, one after the other: those begin anew with every match.
        const std::size_t rows_tables = arena.used();
        bench.refiner.lay_out(arena, scene);
        arena.rewind(rows_tables);
        bench.highlights.lay_out(arena, scene);
        arena.rewind(rows_tables);
        scene.right_edges.lay_out(arena, scene.width, scene.height, scene.axis - 1);
        bench.raw.lay_out(arena, scene, ColumnPaths::most_rows_at_once(window));
        bench.paths.lay_out(arena, scene, workers);
    }
    for (int i = 0; i < workers; ++i) {
        Station measured;
        Station& station = arena.measuring() ? measured : bench.stations[static_cast<std::size_t>(i)];
        if (options.method == MatchMethod::kFast)
            station.fast.lay_out(arena, scene);
        else
            station.costs.lay_out(arena, scene, best ? &bench.raw : nullptr);
        if (options.method != MatchMethod::kPaper)
            station.scanline.lay_out(arena, scene);
        station.selector.lay_out(arena, scene);
    }
}

/// Nothing lies farther than disparity 0.
int farther_of(const MatchOptions& options)
{
    if (options.method != MatchMethod::kBest)
        return 0;
    return std::clamp(options.min_disparity, 0,
                      std::min(options.disparities / kFartherShare, kMaxDisparities - options.disparities));
}

Scene scene_of(int width, int height, const MatchOptions& options, const Kernels& kernels)
{
    Scene scene{};
    scene.kernels = &kernels;
    scene.width = width;
    scene.height = height;
    scene.radius = options.window / 2;
    scene.farther = farther_of(options);
    scene.disparities = options.disparities + scene.farther;
    scene.axis = (scene.disparities + kLanes - 1) / kLanes * kLanes;
    scene.min_disparity = options.min_disparity - scene.farther;
    scene.near_window = options.method == MatchMethod::kBest && scene.radius >= NearWindow::kRadius;
    return scene;
}

} // namespace
} // namespace matching

Status Matcher::check(int width, int height, const MatchOptions& options)
{
    constexpr int kLeastSide = 8;
    constexpr int kMaxSide = 16384; // sums of columns and margins stay far below 2^31
    if (width < kLeastSide || height < kLeastSide)
        return failure(Fault::kBadData, "the pictures are %d x %d px; the smallest that can be matched is %d x %d",
                       width, height, kLeastSide, kLeastSide);
    if (width > kMaxSide || height > kMaxSide)
        return failure(Fault::kBadData, "the pictures are %d x %d px; the largest that can be matched is %d x %d",
                       width, height, kMaxSide, kMaxSide);
    if (options.disparities < 1 || options.disparities > kMaxDisparities)
        return failure(Fault::kUsage, "%d disparities: choose 1 to %d, or match smaller pictures", options.disparities,
                       kMaxDisparities);
    if (options.disparities > width)
        return failure(Fault::kUsage, "%d disparities are wider than the pictures (%d px): choose at most %d",
                       options.disparities, width, std::min(width, kMaxDisparities));
    if (options.min_disparity <= -width || options.min_disparity >= width)
        return failure(Fault::kUsage, "a least disparity of %d leaves nothing to match in pictures %d px wide",
                       options.min_disparity, width);
    if (options.window < 3 || options.window > kMaxWindow || options.window % 2 == 0)
        return failure(Fault::kUsage, "a window of %d: choose an odd number from 3 to %d", options.window, kMaxWindow);
    if (!(options.gamma_color >= 0.5 && options.gamma_color <= 100))
        return failure(Fault::kUsage, "gamma-color %g: choose 0.5 to 100 (CIELAB units)", options.gamma_color);
    if (!(options.gamma_space >= 0.5 && options.gamma_space <= 1000))
        return failure(Fault::kUsage, "gamma-space %g: choose 0.5 to 1000 (px)", options.gamma_space);
    return {};
}

Result<Matcher> Matcher::make(int width, int height, const MatchOptions& options, const Kernels& kernels, int workers,
                              Arena& arena)
{
    using namespace matching;
    TRY(check(width, height, options));
    workers = std::clamp(workers, 1, height);

    Matcher matcher;
    matcher.options_ = options;

    // First what it takes, then the real thing: nothing is written into an arena that is too small.
    Arena measure;
    // Where the range begins must not matter, so it is measured with all that may be searched beyond it.
    MatchOptions widest = options;
    widest.min_disparity = std::max(options.min_disparity, options.disparities);
    Bench measured{};
    measured.scene = scene_of(width, height, widest, kernels);
    (void)measure.take<Bench>(1);
    (void)measure.take<Station>(static_cast<std::size_t>(workers));
    lay_out(measured, measure, options, workers);
    const std::span<std::byte> block = arena.take<std::byte>(measure.peak());
    if (arena.measuring())
        return matcher;
    if (block.empty())
        return failure(Fault::kConfig, "matching needs %zu KiB and the arena has %zu KiB left", measure.peak() >> 10,
                       (arena.size() - std::min(arena.size(), arena.used() - measure.peak())) >> 10);

    Arena own(block);
    Bench* bench = ::new (own.take<Bench>(1).data()) Bench{};
    bench->scene = scene_of(width, height, options, kernels);
    bench->stations = own.take<Station>(static_cast<std::size_t>(workers));
    for (Station& station : bench->stations)
        ::new (&station) Station{};
    lay_out(*bench, own, options, workers);
    fill(bench->lab);
    bench->scene.colour.fill(options.gamma_color);
    bench->voters.fill(kVotersGamma * options.gamma_color);
    fill_spatial_weights(bench->scene.left_spatial.data(), bench->scene.right_spatial.data(), bench->scene.radius,
                         options.method == MatchMethod::kFast ? kLineReach * options.gamma_space : options.gamma_space);
    fill_costs(bench->scene.costs, options.cost);
    matcher.bench_ = bench;
    return matcher;
}

std::uint64_t Matcher::terms() const
{
    const matching::Scene& scene = bench_->scene;
    const auto window = static_cast<std::uint64_t>(2 * scene.radius + 1);
    const auto column = static_cast<std::uint64_t>(2 * (scene.radius / matching::kRowStep) + 1);
    const auto cells = options_.method == MatchMethod::kFast ? window + column : window * window;
    return cells * static_cast<std::uint64_t>(scene.width) * static_cast<std::uint64_t>(scene.height) *
           static_cast<std::uint64_t>(scene.disparities);
}

MatchOutcome Matcher::match(ImageView<const Rgb8> left, ImageView<const Rgb8> right, Crew& crew,
                            const MatchHooks& hooks)
{
    using namespace matching;
    Bench& bench = *bench_;
    Scene& scene = bench.scene;
    const int workers = static_cast<int>(bench.stations.size());
    const auto clock = [&] { return hooks.now_ns ? hooks.now_ns() : 0; };
    const bool check_both_ways = options_.method != MatchMethod::kPaper;

    const std::uint64_t start = clock();
    crew.run(workers, [&](int worker) {
        const int from = scene.height * worker / workers;
        const int to = scene.height * (worker + 1) / workers;
        scene.left.fill_rows(left, 0, bench.lab, from, to);
        scene.right.fill_rows(right, scene.min_disparity, bench.lab, from, to);
    });
    if (options_.method == MatchMethod::kBest)
        crew.run(workers, [&](int worker) {
            scene.right_edges.fill_rows(scene.right, scene.height * worker / workers,
                                        scene.height * (worker + 1) / workers);
        });
    const std::uint64_t prepared = clock();

    RowWork(bench, options_, hooks, workers).run(crew);

    const std::uint64_t matched = clock();
    const bool best = options_.method == MatchMethod::kBest;
    if (best) {
        drop_clipped(bench.maps, scene.min_disparity);
        drop_speckles(bench.maps, bench.columns);
    }
    if (!best && !options_.dense)
        drop_unmatched(bench.maps);
    if (best)
        bench.refiner.refine(scene, bench.maps, options_.dense, crew);
    if (best) {
        if (!options_.dense)
            bench.highlights.match(scene, bench.maps, crew);
        drop_farther(bench.maps, scene.farther);
    }
    if (options_.dense && best) {
        take_majorities(bench.maps, options_.disparities, scene.left, bench.voters, crew);
        fill_along_planes(bench.maps, options_.disparities, scene.left, bench.voters, crew);
        smooth_evenly(bench.maps, crew);
    } else if (options_.dense) {
        fill_gaps(bench.maps);
        if (check_both_ways)
            smooth(bench.maps, scene.left, scene.colour, crew);
    }

    MatchOutcome outcome{};
    outcome.map.relative = bench.maps.disparity;
    outcome.map.confidence = bench.maps.confidence;
    outcome.map.min_disparity = options_.min_disparity;
    outcome.map.disparities = options_.disparities;
    outcome.times = bench.stations[0].times;
    outcome.times.prepare = prepared - start;
    outcome.times.refine = clock() - matched;
    return outcome;
}

} // namespace dicot
