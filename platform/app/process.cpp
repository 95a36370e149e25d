// dicot process: a pair in, a compressed cloud out.
#include "commands.h"
#include "distinct_files.h"
#include "match_words.h"
#include "process_bench.h"
#include "progress.h"
#include "rectify_rig.h"
#include "rig_source.h"
#include "sealed_heap.h"
#include "take_picture.h"

#include "dicot/cloud/disparity_picture.h"
#include "dicot/cloud/render.h"
#include "dicot/cloud/triangulate.h"
#include "dicot/cloud/working_range.h"
#include "dicot/codec/encode_cloud.h"
#include "dicot/export/export_cloud.h"
#include "dicot/os/clock.h"
#include "dicot/os/output_file.h"
#include "dicot/os/process_memory.h"
#include "dicot/os/thread_crew.h"
#include "dicot/picture/read_picture.h"
#include "dicot/picture/write_picture.h"
#include "dicot/rig/rig_file.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

namespace dicot::app {
namespace {

struct Words
{
    std::string left, right, rig, cloud, ply, preview, disparity;
    std::optional<double> near_mm, far_mm;
    MatchWords match;
    bool json = false;
};

/// What follows from the words, the rig file and the pictures' sizes, before anything large begins.
struct Plan
{
    RigGeometry rig;
    std::optional<RectifyTables> tables; ///< when the pictures come from the cameras as they are
    WorkingRange range;
    Triangulation triangulation;
    MatchOptions match;
    const Kernels* kernels = nullptr;
    int threads = 1;
    CloudMeta meta;
};

/// What the work found out.
struct Findings
{
    PixelCount pixels;
    CloudProof proof;
    std::size_t cloud_bytes = 0;
    std::size_t heap_peak_bytes = 0;
};

struct StageTimes
{
    double read_s = 0, rectify_s = 0, match_s = 0, triangulate_s = 0, encode_s = 0, write_s = 0, pictures_s = 0;
};

/// Seconds since it was asked last.
class StopWatch
{
public:
    double lap_s()
    {
        const std::int64_t now = monotonic_us();
        const double lap = static_cast<double>(now - last_us_) * 1e-6;
        last_us_ = now;
        return lap;
    }

private:
    std::int64_t last_us_ = monotonic_us();
};

Status check_output(const std::string& path, const char* ending)
{
    if (path.empty())
        return {};
    if (!CLI::detail::to_lower(path).ends_with(ending))
        return failure(Fault::kUsage, "%s: the name must end in %s", path.c_str(), ending);
    OutputFile can_be_written;
    return can_be_written.open(path.c_str());
}

Status check_outputs(const Words& words)
{
    TRY(check_distinct({words.left, words.right, words.rig}, {words.cloud, words.ply, words.preview, words.disparity}));
    TRY(check_output(words.cloud, ".drc"));
    TRY(check_output(words.ply, ".ply"));
    TRY(check_output(words.preview, ".png"));
    return check_output(words.disparity, ".png");
}

Status check_size(const std::string& picture, const std::string& rig_path, const RigFile& rig)
{
    const PictureSize size = TRY(picture_size(picture.c_str()));
    if (size.width != rig.width || size.height != rig.height)
        return failure(Fault::kBadData,
                       "%s is %d x %d px, and %s is for %d x %d: use the rig file of these cameras and this size",
                       picture.c_str(), size.width, size.height, rig_path.c_str(), rig.width, rig.height);
    return {};
}

Result<WorkingRange> range_of(const Words& words, const RigFile& rig)
{
    const std::optional<double> near_mm = words.near_mm ? words.near_mm : rig.near_mm;
    const std::optional<double> far_mm = words.far_mm ? words.far_mm : rig.far_mm;
    if (!near_mm || !far_mm)
        return failure(Fault::kUsage,
                       "%s names no working range: give --near-mm and --far-mm, or add near_mm and far_mm to it",
                       words.rig.c_str());
    return WorkingRange{*near_mm, *far_mm};
}

Result<Plan> make_plan(const Words& words)
{
    Plan plan;
    plan.kernels = TRY(choose_kernels(words.match.cpu));
    plan.threads = words.match.resolved_threads();
    RigFile rig = TRY(read_rig_for_use(words.rig));
    TRY(check_size(words.left, words.rig, rig));
    TRY(check_size(words.right, words.rig, rig));
    if (describes_cameras(rig))
        plan.tables = TRY(RectifyTables::load_or_build(rig, kCrop, words.rig.c_str()));
    plan.rig = TRY(geometry_of(rig, words.rig.c_str()));
    plan.range = TRY(range_of(words, rig));
    const DisparityRange search = TRY(disparity_range(plan.rig, plan.range));
    const CloudGrid grid = TRY(grid_for(plan.rig, plan.range));
    plan.triangulation = TRY(triangulation_for(plan.rig, plan.range, grid));
    plan.match = words.match.resolved();
    plan.match.min_disparity = search.min_disparity;
    plan.match.disparities = search.disparities;
    plan.meta.software = "dicot " DICOT_VERSION;
    plan.meta.calibration_id = rig.id;
    plan.meta.near_mm = plan.range.near_mm;
    plan.meta.far_mm = plan.range.far_mm;
    return plan;
}

Status write_bytes(const std::string& path, std::span<const std::byte> bytes)
{
    OutputFile file;
    TRY(file.open(path.c_str()));
    TRY(file.write(bytes));
    return file.commit();
}

/// From the pictures to points; the disparity map is gone afterwards.
Result<PointCloud> see(const Words& words, const Plan& plan, ProcessBench& bench, Crew& crew, Findings& findings,
                       StageTimes& times)
{
    StopWatch watch;
    const int width = plan.rig.width;
    const int height = plan.rig.height;
    Arena stage = bench.next_stage();
    const auto left = take_picture<Rgb8>(stage, width, height);
    const auto right = take_picture<Rgb8>(stage, width, height);
    const auto painted = take_picture<Rgb8>(stage, width, height);
    Matcher matcher = TRY(Matcher::make(width, height, plan.match, *plan.kernels, plan.threads, stage));
    // The decoded picture lies where the disparities are painted later.
    for (const auto& [path, table, into] :
         {std::tuple{&words.left, plan.tables ? &plan.tables->left() : nullptr, left},
          std::tuple{&words.right, plan.tables ? &plan.tables->right() : nullptr, right}}) {
        TRY(read_picture(path->c_str(), table != nullptr ? painted : into));
        times.read_s += watch.lap_s();
        if (table != nullptr)
            remap(*table, *plan.kernels, painted, into, plan.tables->spans());
        times.rectify_s += watch.lap_s();
    }

    const DisparityMap map = [&] {
        Progress progress("matching");
        return matcher.match(left, right, crew, {nullptr, Progress::rows_done, &progress}).map;
    }();
    times.match_s = watch.lap_s();

    const Triangulated seen = triangulate(map, left, plan.triangulation, bench.kept);
    findings.pixels = seen.pixels;
    times.triangulate_s = watch.lap_s();

    if (!words.disparity.empty() && !seen.cloud.points.empty()) {
        paint_disparities(map, painted);
        TRY(write_png(words.disparity.c_str(), painted));
    }
    times.pictures_s = watch.lap_s();
    return seen.cloud;
}

Status keep(const Words& words, const Plan& plan, const ProcessBench& bench, const PointCloud& cloud,
            Findings& findings, StageTimes& times)
{
    StopWatch watch;
    Arena stage = bench.next_stage();
    const EncodedCloud encoded =
        TRY(encode_cloud(cloud, plan.meta, stage.take<std::byte>(encode_heap_bytes(cloud.points.size()))));
    findings.proof = encoded.proof;
    findings.cloud_bytes = encoded.bytes.size();
    findings.heap_peak_bytes = encoded.heap_peak_bytes;
    times.encode_s = watch.lap_s();
    if (!words.ply.empty())
        TRY(write_ply(words.ply.c_str(), cloud, plan.meta));
    TRY(write_bytes(words.cloud, encoded.bytes));
    times.write_s = watch.lap_s();
    return {};
}

Status show(const Words& words, const Plan& plan, const ProcessBench& bench, const PointCloud& cloud, StageTimes& times)
{
    if (words.preview.empty())
        return {};
    StopWatch watch;
    Arena stage = bench.next_stage();
    const PreviewSize size = preview_size(plan.rig.width, plan.rig.height);
    const auto picture = take_picture<Rgb8>(stage, size.width, size.height);
    render_two_views(cloud, plan.rig.focal_px, picture, stage);
    TRY(write_png(words.preview.c_str(), picture));
    times.pictures_s += watch.lap_s();
    return {};
}

nlohmann::json report_of(const Words& words, const Plan& plan, const ProcessBudget& budget, const Findings& found,
                         const StageTimes& times, std::uint64_t peak_bytes)
{
    const CloudGrid& grid = plan.triangulation.grid;
    const auto metres = [&](const std::int32_t(&steps)[3]) {
        const double step = grid.step_um * 1e-6;
        return nlohmann::json{steps[0] * step, steps[1] * step, steps[2] * step};
    };
    nlohmann::json tables; // null: none were needed
    if (plan.tables) {
        const std::string& file = plan.tables->loaded_from();
        tables = {{"loaded_from", file.empty() ? nlohmann::json() : nlohmann::json(file)},
                  {"ms", plan.tables->milliseconds()}};
    }
    return {{"output", words.cloud},
            {"width", plan.rig.width},
            {"height", plan.rig.height},
            {"near_mm", plan.range.near_mm},
            {"far_mm", plan.range.far_mm},
            {"min_disparity_px", plan.match.min_disparity},
            {"disparities", plan.match.disparities},
            {"method", words.match.method},
            {"kernels", plan.kernels->name},
            {"threads", plan.threads},
            {"points", found.pixels.points},
            {"pixels",
             {{"missing", found.pixels.missing},
              {"beyond", found.pixels.beyond},
              {"too_near", found.pixels.too_near},
              {"too_far", found.pixels.too_far},
              {"outside_grid", found.pixels.outside_grid}}},
            {"bytes", found.cloud_bytes},
            {"bits_per_point", 8.0 * static_cast<double>(found.cloud_bytes) / static_cast<double>(found.pixels.points)},
            {"grid", {{"step_m", grid.step_um / 1e6}, {"bits", grid.bits}}},
            {"proof",
             {{"points", found.proof.points},
              {"least_m", metres(found.proof.least)},
              {"most_m", metres(found.proof.most)},
              {"worst_error_um", found.proof.worst_error_um}}},
            {"stages_s",
             {{"read", times.read_s},
              {"rectify", times.rectify_s},
              {"match", times.match_s},
              {"triangulate", times.triangulate_s},
              {"encode", times.encode_s},
              {"write", times.write_s},
              {"pictures", times.pictures_s}}},
            {"rectified", plan.tables.has_value()},
            {"tables", tables},
            {"reserved_memory_bytes", budget.total()},
            {"compressor_peak_bytes", found.heap_peak_bytes},
            {"peak_memory_bytes", peak_bytes}};
}

void print(const Words& words, const Plan& plan, const Findings& found, const StageTimes& times,
           std::uint64_t peak_bytes)
{
    constexpr double kMiB = 1 << 20;
    const PixelCount& pixels = found.pixels;
    std::printf("%s: %lld points, %.2f MiB, %.1f bits a point; decoded again, worst error %.2f um on a grid of %d um\n",
                words.cloud.c_str(), static_cast<long long>(pixels.points),
                static_cast<double>(found.cloud_bytes) / kMiB,
                8.0 * static_cast<double>(found.cloud_bytes) / static_cast<double>(pixels.points),
                found.proof.worst_error_um, plan.triangulation.grid.step_um);
    std::printf("searched %d disparities from %d px for %.0f to %.0f mm; of %d x %d pixels %lld had no match, %lld "
                "were nearer, "
                "%lld farther\n",
                plan.match.disparities, plan.match.min_disparity, plan.range.near_mm, plan.range.far_mm, plan.rig.width,
                plan.rig.height, static_cast<long long>(pixels.missing), static_cast<long long>(pixels.too_near),
                static_cast<long long>(pixels.too_far + pixels.beyond));
    if (plan.tables)
        std::printf("rectification tables: %s\n", plan.tables->origin().c_str());
    std::printf("read %.3f s, rectify %.3f s, match %.3f s (%s, %d threads), triangulate %.3f s, encode and verify "
                "%.3f s, write %.3f s, "
                "pictures %.3f s; peak memory %.1f MiB\n",
                times.read_s, times.rectify_s, times.match_s, plan.kernels->name, plan.threads, times.triangulate_s,
                times.encode_s, times.write_s, times.pictures_s, static_cast<double>(peak_bytes) / kMiB);
}

Status run(const Words& words)
{
    TRY(check_outputs(words));
    const Plan plan = TRY(make_plan(words));
    const Pictures pictures = plan.tables ? Pictures::kRaw : Pictures::kRectified;
    ProcessBench bench = TRY(ProcessBench::make(plan.rig.width, plan.rig.height, pictures, plan.match, plan.threads));
    ThreadCrew crew(plan.threads);
    TRY(crew.started());
    Findings findings;
    StageTimes times;
    {
        const SealedHeap sealed;
        const PointCloud cloud = TRY(see(words, plan, bench, crew, findings, times));
        TRY(keep(words, plan, bench, cloud, findings, times));
        TRY(show(words, plan, bench, cloud, times));
    }
    const ProcessMemory memory = TRY(process_memory());
    if (words.json)
        std::printf("%s\n", report_of(words, plan, bench.budget(), findings, times, memory.peak_bytes).dump(2).c_str());
    else
        print(words, plan, findings, times, memory.peak_bytes);
    return {};
}

} // namespace

void add_process(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("process", "Compressed 3D cloud of a stereo pair");
    auto words = std::make_shared<Words>();
    command
        ->add_option("LEFT", words->left,
                     "left picture: PNG, JPEG or PPM; rectified when the rig file has P1 and P2 only")
        ->required();
    command->add_option("RIGHT", words->right, "right picture")->required();
    command->add_option("--rig", words->rig, "rig file of the two cameras (YAML)")->required();
    command->add_option("-o,--output", words->cloud, "cloud, .drc")->required();
    command->add_option("--ply", words->ply, "the cloud as .ply too");
    command->add_option("--preview", words->preview, "picture of the cloud from two viewpoints, .png");
    command->add_option("--disparity", words->disparity, "picture of the disparities in colour, .png");
    command->add_option("--near-mm", words->near_mm, "nearest distance of the working range (default: the rig file's)");
    command->add_option("--far-mm", words->far_mm, "farthest distance of the working range (default: the rig file's)");
    words->match.add_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
