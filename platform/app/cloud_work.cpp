#include "cloud_work.h"

#include "progress.h"
#include "take_picture.h"

#include "dicot/cloud/disparity_picture.h"
#include "dicot/cloud/render.h"
#include "dicot/export/export_cloud.h"
#include "dicot/matching/matcher.h"
#include "dicot/os/stage_watch.h"
#include "dicot/picture/write_picture.h"

#include <optional>
#include <span>
#include <utility>

namespace dicot::app {
namespace {

constexpr int kJpegQuality = 90;

Status put_png(FileShelf& shelf, const std::string& name, ImageView<const Rgb8> picture)
{
    return shelf.put(name.c_str(), [&](ByteSink& sink) { return write_png(sink, name.c_str(), picture); });
}

} // namespace

CloudWork::CloudWork(const CloudPlan& plan, ProcessBench bench)
    : plan_(plan), bench_(std::move(bench)), crew_(plan.threads)
{
}

Result<std::unique_ptr<CloudWork>> CloudWork::make(const CloudPlan& plan, std::size_t scratch_bytes)
{
    const Pictures pictures = plan.tables ? Pictures::kRaw : Pictures::kRectified;
    ProcessBench bench =
        TRY(ProcessBench::make(plan.rig.width, plan.rig.height, pictures, plan.match, plan.threads, scratch_bytes));
    std::unique_ptr<CloudWork> work(new CloudWork(plan, std::move(bench)));
    TRY(work->crew_.started());
    return work;
}

Status CloudWork::see(PairSource& source, const PictureNames& names, FileShelf& shelf, bool shows_progress)
{
    StopWatch watch;
    times = {};
    drift_ = {};
    StageWatch::enter("capture", stage_bound_us);
    const int width = plan_.rig.width;
    const int height = plan_.rig.height;
    Arena stage = bench_.next_stage();
    const auto left = take_picture<Rgb8>(stage, width, height);
    const auto right = take_picture<Rgb8>(stage, width, height);
    const auto painted = take_picture<Rgb8>(stage, width, height);
    if (plan_.tables) {
        // What the cameras saw lies where the disparities are painted later, and where the matcher works.
        Arena before_matching = stage;
        const auto raw_right = take_picture<Rgb8>(before_matching, width, height);
        TRY(source.fill(painted, raw_right, before_matching));
        times.read_s = watch.lap_s();
        StageWatch::enter("rectify", stage_bound_us);
        remap(plan_.tables->left(), *plan_.kernels, painted, left, plan_.tables->spans());
        remap(plan_.tables->right(), *plan_.kernels, raw_right, right, plan_.tables->spans());
        times.rectify_s = watch.lap_s();
    } else {
        TRY(source.fill(left, right, stage));
        times.read_s = watch.lap_s();
    }
    if (!names.left.empty())
        TRY(shelf.put(names.left.c_str(),
                      [&](ByteSink& sink) { return write_jpeg(sink, names.left.c_str(), left, kJpegQuality); }));
    times.pictures_s = watch.lap_s();

    StageWatch::enter("match", stage_bound_us);
    Matcher matcher = TRY(Matcher::make(width, height, plan_.match, *plan_.kernels, plan_.threads, stage));
    const DisparityMap map = [&] {
        if (!shows_progress)
            return matcher
                .match(left, right, crew_, {nullptr, [](void*, int, int) { StageWatch::progress(); }, nullptr})
                .map;
        Progress progress("matching");
        return matcher.match(left, right, crew_, {nullptr, Progress::rows_done, &progress}).map;
    }();
    times.match_s = watch.lap_s();
    // In the memory where disparities are painted later: it is larger than what the measurement takes.
    Arena beside{std::as_writable_bytes(
        std::span{painted.data, static_cast<std::size_t>(width) * static_cast<std::size_t>(height)})};
    if (drift_scratch_bytes(width, height) <= beside.size())
        drift_ = TRY(measure_drift(left, right, map, beside));
    times.drift_s = watch.lap_s();

    Arena kept = bench_.kept;
    const Triangulated seen = triangulate(map, left, plan_.triangulation, kept);
    cloud_ = seen.cloud;
    pixels_ = seen.pixels;
    times.triangulate_s = watch.lap_s();
    if (!names.disparity.empty() && !cloud_.points.empty()) {
        paint_disparities(map, painted);
        TRY(put_png(shelf, names.disparity, painted));
    }
    times.pictures_s += watch.lap_s();
    return {};
}

Status CloudWork::encode(const CloudMeta& meta)
{
    StopWatch watch;
    StageWatch::enter("encode", stage_bound_us);
    Arena stage = bench_.next_stage();
    encoded_ = TRY(encode_cloud(cloud_, meta, stage.take<std::byte>(encode_heap_bytes(cloud_.points.size()))));
    times.encode_s = watch.lap_s();
    return {};
}

Status CloudWork::write_cloud(const char* name, FileShelf& shelf)
{
    StopWatch watch;
    TRY(shelf.put(name, [this](ByteSink& sink) { return sink.write(encoded_.bytes); }));
    times.write_s += watch.lap_s();
    return {};
}

Status CloudWork::write_ply(const std::string& path)
{
    StopWatch watch;
    TRY(dicot::write_ply(path.c_str(), cloud_, plan_.meta));
    times.write_s += watch.lap_s();
    return {};
}

Status CloudWork::write_preview(const PictureNames& names, FileShelf& shelf)
{
    if (names.preview.empty())
        return {};
    StopWatch watch;
    Arena stage = bench_.next_stage();
    const PreviewSize size = preview_size(plan_.rig.width, plan_.rig.height);
    const auto picture = take_picture<Rgb8>(stage, size.width, size.height);
    render_two_views(cloud_, plan_.rig.focal_px, picture, stage);
    TRY(put_png(shelf, names.preview, picture));
    times.pictures_s += watch.lap_s();
    return {};
}

} // namespace dicot::app
