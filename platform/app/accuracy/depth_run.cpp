#include "depth_run.h"

#include "../progress.h"
#include "../rectify_rig.h"
#include "../rig_source.h"
#include "../take_picture.h"

#include "dicot/os/clock.h"
#include "dicot/os/shown_path.h"
#include "dicot/os/thread_crew.h"
#include "dicot/picture/read_picture.h"

#include <algorithm>
#include <cmath>

namespace dicot::app {
namespace {

constexpr double kRoom = 0.15; // of the search range beyond the targets, as a share of the distance

/// What all pairs share.
struct Bench
{
    LeftView view;
    std::optional<RectifyTables> tables;
    const Kernels* kernels = nullptr;
    MatchOptions options;
    MemoryBlock block;
    ImageView<Rgb8> raw_left, raw_right, left, right;
};

Result<Bench> make_bench(const DepthWords& words, const std::vector<Target>& targets, DepthRun& run)
{
    Bench bench;
    bench.kernels = TRY(choose_kernels(words.match.cpu));
    RigFile rig = TRY(read_rig_for_use(words.rig));
    run.rig_id = rig.id;
    for (const Target& target : targets) {
        const PictureSize size = TRY(picture_size(target.left_path.c_str()));
        if (size.width != rig.width || size.height != rig.height)
            return failure(Fault::kBadData,
                           "%s is %d x %d px, and %s is for %d x %d: use the rig file of these cameras and this size",
                           shown_path(target.left_path.c_str()), size.width, size.height, shown_path(words.rig.c_str()),
                           rig.width, rig.height);
    }
    if (describes_cameras(rig)) {
        bench.tables = TRY(RectifyTables::load_or_build(rig, kCrop, words.rig.c_str()));
        bench.view.lens = TRY(stereo_rig_of(rig, words.rig.c_str())).left;
        for (std::size_t i = 0; i < 9; ++i)
            bench.view.from_camera[i] = (*rig.left.rectifying)[i / 3][i % 3];
    }
    run.rig = bench.view.rig = TRY(geometry_of(rig, words.rig.c_str()));

    const double nearest = targets.front().distance_mm, farthest = targets.back().distance_mm;
    const double widest_px = run.rig.focal_px * run.rig.baseline_mm / nearest;
    if (widest_px > run.rig.width)
        return failure(Fault::kBadData,
                       "%s: at %g mm the cameras of %s see nothing in common: is the distance told in mm?",
                       shown_path(targets.front().left_path.c_str()), nearest, shown_path(words.rig.c_str()));
    run.range.near_mm = words.near_mm.value_or(std::min(rig.near_mm.value_or(nearest), (1 - kRoom) * nearest));
    run.range.far_mm = words.far_mm.value_or(std::max(rig.far_mm.value_or(farthest), (1 + kRoom) * farthest));
    run.search = TRY(disparity_range(run.rig, run.range));
    if (nearest < run.range.near_mm || farthest > run.range.far_mm)
        return failure(Fault::kUsage,
                       "%s stands at %g mm, outside of the search from %g to %g mm: widen --near-mm or "
                       "--far-mm",
                       shown_path((nearest < run.range.near_mm ? targets.front() : targets.back()).left_path.c_str()),
                       nearest < run.range.near_mm ? nearest : farthest, run.range.near_mm, run.range.far_mm);
    bench.options = words.match.resolved();
    bench.options.min_disparity = run.search.min_disparity;
    bench.options.disparities = run.search.disparities;
    TRY(Matcher::check(rig.width, rig.height, bench.options));

    const auto lay_out = [&](Arena& arena) {
        for (ImageView<Rgb8>* picture : {&bench.raw_left, &bench.raw_right, &bench.left, &bench.right})
            *picture = take_picture<Rgb8>(arena, rig.width, rig.height);
    };
    Arena measuring;
    lay_out(measuring);
    bench.block = TRY(MemoryBlock::map(measuring.peak()));
    Arena arena(bench.block.bytes());
    lay_out(arena);
    return bench;
}

Status see(const Target& target, Bench& bench)
{
    const bool raw = bench.tables.has_value();
    TRY(read_picture(target.left_path.c_str(), raw ? bench.raw_left : bench.left));
    TRY(read_picture(target.right_path.c_str(), raw ? bench.raw_right : bench.right));
    if (raw) {
        remap(bench.tables->left(), *bench.kernels, bench.raw_left, bench.left, bench.tables->spans());
        remap(bench.tables->right(), *bench.kernels, bench.raw_right, bench.right, bench.tables->spans());
    }
    return {};
}

ImageView<const Rgb8> cut(const ImageView<Rgb8>& picture, const PictureRange& part)
{
    return {&picture.at(part.first, part.top), part.width(), part.height(), picture.stride};
}

/// The rows of one pair as a part of all pairs.
struct PairProgress
{
    Progress progress{"measuring"};
    int pair = 0;
    int pairs = 0;

    static void rows_done(void* context, int rows, int all)
    {
        constexpr int kSteps = 1000;
        auto* self = static_cast<PairProgress*>(context);
        self->progress.done(kSteps * self->pair + kSteps * rows / std::max(1, all), kSteps * self->pairs);
    }
};

Result<FaceDepth> measure_target(const Target& target, const DepthWords& words, Bench& bench, const DepthRun& run,
                                 Crew& crew, PairProgress& progress)
{
    const Face face = TRY(Face::of(target, bench.view));
    TRY(see(target, bench));
    PictureRange part{0, run.rig.width, 0, run.rig.height}, partner = part;
    DisparityRange shift = {0, run.search.disparities};
    MatchOptions options = bench.options;
    if (!words.whole) {
        part = partner = matched_part(face, run.rig, run.search);
        partner.first -= run.search.min_disparity;
        partner.end -= run.search.min_disparity;
        shift.min_disparity = run.search.min_disparity;
        options.min_disparity = 0;
    }
    Arena measuring;
    (void)TRY(Matcher::make(part.width(), part.height(), options, *bench.kernels, crew.size(), measuring));
    const MemoryBlock block = TRY(MemoryBlock::map(measuring.peak()));
    Arena arena(block.bytes());
    Matcher matcher = TRY(Matcher::make(part.width(), part.height(), options, *bench.kernels, crew.size(), arena));
    const DisparityMap map = matcher
                                 .match(cut(bench.left, part), cut(bench.right, partner), crew,
                                        {nullptr, PairProgress::rows_done, &progress})
                                 .map;
    return measure(target, face, bench.view, part, shift, map);
}

} // namespace

int DepthRun::measured() const
{
    return static_cast<int>(std::ranges::count_if(readings, &DepthReading::measured));
}

int DepthRun::within_bound() const
{
    return static_cast<int>(std::ranges::count_if(readings, &DepthReading::within_bound));
}

const DepthReading* DepthRun::worst(double most_mm) const
{
    const DepthReading* worst = nullptr;
    for (const DepthReading& r : readings)
        if (r.measured() && r.target.distance_mm <= most_mm &&
            (worst == nullptr || std::abs(r.face.error_mm) > std::abs(worst->face.error_mm)))
            worst = &r;
    return worst;
}

Result<DepthRun> run_depths(const DepthWords& words)
{
    const std::int64_t start_us = monotonic_us();
    DepthRun run;
    TargetList list = TRY(list_targets(words.targets));
    run.alone = list.alone;
    run.source = list.source;
    Bench bench = TRY(make_bench(words, list.targets, run));
    ThreadCrew crew(words.match.resolved_threads());
    TRY(crew.started());
    PairProgress progress;
    progress.pairs = static_cast<int>(list.targets.size());
    std::vector<TrendPoint> points;
    for (Target& target : list.targets) {
        DepthReading reading;
        const Result<FaceDepth> face = measure_target(target, words, bench, run, crew, progress);
        if (face.ok())
            reading.face = face.value();
        else if (face.status().fault() == Fault::kBadData || face.status().fault() == Fault::kNoInput)
            reading.lost = face.status().message();
        else
            return face.status();
        if (reading.lost.empty() && reading.face.valued == 0)
            reading.lost = "no pixel of the target has a disparity: it has no texture, or lies outside of the search";
        reading.bound_mm = depth_bound_mm(run.rig, target.distance_mm, kStepPx);
        reading.target = std::move(target);
        if (reading.measured())
            points.push_back({reading.target.distance_mm, reading.face.error_mm, reading.face.disparity_px});
        run.readings.push_back(std::move(reading));
        ++progress.pair;
    }
    if (points.empty())
        return failure(Fault::kBadData, "no target gave a depth; the first one: %.300s",
                       run.readings.front().lost.c_str());
    run.trend = find_trend(points, run.rig.focal_px * run.rig.baseline_mm);
    run.seconds = static_cast<double>(monotonic_us() - start_us) * 1e-6;
    return run;
}

} // namespace dicot::app
