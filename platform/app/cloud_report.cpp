#include "cloud_report.h"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace dicot::app {

nlohmann::json cloud_report(const CloudWork& work, const std::string& method, std::uint64_t peak_bytes)
{
    const CloudPlan& plan = work.plan();
    const PixelCount& pixels = work.pixels();
    const EncodedCloud& encoded = work.encoded();
    const StageTimes& times = work.times;
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
    return {{"width", plan.rig.width},
            {"height", plan.rig.height},
            {"near_mm", plan.range.near_mm},
            {"far_mm", plan.range.far_mm},
            {"min_disparity_px", plan.match.min_disparity},
            {"disparities", plan.match.disparities},
            {"method", method},
            {"kernels", plan.kernels->name},
            {"threads", plan.threads},
            {"points", pixels.points},
            {"pixels",
             {{"missing", pixels.missing},
              {"beyond", pixels.beyond},
              {"too_near", pixels.too_near},
              {"too_far", pixels.too_far},
              {"outside_grid", pixels.outside_grid}}},
            {"bytes", encoded.bytes.size()},
            {"bits_per_point", 8.0 * static_cast<double>(encoded.bytes.size()) / static_cast<double>(pixels.points)},
            {"grid", {{"step_m", grid.step_um / 1e6}, {"bits", grid.bits}}},
            {"proof",
             {{"points", encoded.proof.points},
              {"least_m", metres(encoded.proof.least)},
              {"most_m", metres(encoded.proof.most)},
              {"worst_error_um", encoded.proof.worst_error_um}}},
            {"stages_s",
             {{"read", times.read_s},
              {"rectify", times.rectify_s},
              {"match", times.match_s},
              {"drift", times.drift_s},
              {"triangulate", times.triangulate_s},
              {"encode", times.encode_s},
              {"write", times.write_s},
              {"pictures", times.pictures_s}}},
            {"rectified", plan.tables.has_value()},
            {"tables", tables},
            {"reserved_memory_bytes", work.budget().total()},
            {"compressor_peak_bytes", encoded.heap_peak_bytes},
            {"peak_memory_bytes", peak_bytes}};
}

void print_cloud_report(const CloudWork& work, const std::string& cloud, std::uint64_t peak_bytes)
{
    const CloudPlan& plan = work.plan();
    const EncodedCloud& encoded = work.encoded();
    const StageTimes& times = work.times;
    constexpr double kMiB = 1 << 20;
    const PixelCount& pixels = work.pixels();
    std::printf("%s: %lld points, %.2f MiB, %.1f bits a point; decoded again, worst error %.2f um on a grid of %d um\n",
                cloud.c_str(), static_cast<long long>(pixels.points), static_cast<double>(encoded.bytes.size()) / kMiB,
                8.0 * static_cast<double>(encoded.bytes.size()) / static_cast<double>(pixels.points),
                encoded.proof.worst_error_um, plan.triangulation.grid.step_um);
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

} // namespace dicot::app
