#include "calibration_words.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace dicot::app {
namespace {

using nlohmann::json;

const calibration::ViewOutcome* outcome_of(const CalibrationRun& run, const SeenPair& pair)
{
    return run.solved && pair.view >= 0 ? &run.calibration.views[static_cast<std::size_t>(pair.view)] : nullptr;
}

/// Of a pair with a reason not to use it: a board that one camera saw still helps that camera's lens.
const char* how_used(const SeenPair& pair, const calibration::ViewOutcome* outcome)
{
    if (outcome == nullptr || !outcome->used)
        return "not used";
    return pair.left.found ? "left only" : "right only";
}

void print_pairs(const CalibrationRun& run)
{
    std::size_t widest = 0;
    for (const SeenPair& pair : run.pairs)
        widest = std::max(widest, pair.name.size());
    const int column = static_cast<int>(std::min<std::size_t>(widest, 60));
    std::printf("%-*s   RMS left   right\n", column, "pair");
    for (const SeenPair& pair : run.pairs) {
        const calibration::ViewOutcome* outcome = outcome_of(run, pair);
        if (!pair.rejected.empty())
            std::printf("%-*s   %s: %s\n", column, pair.name.c_str(), how_used(pair, outcome), pair.rejected.c_str());
        else if (outcome != nullptr)
            std::printf("%-*s   %8.3f %7.3f px\n", column, pair.name.c_str(), outcome->rms_left_px,
                        outcome->rms_right_px);
        else
            std::printf("%-*s   board found\n", column, pair.name.c_str());
    }
    for (const LonePicture& lone : run.alone)
        std::printf("%-*s   no pair: %s\n", column, lone.name.c_str(), lone.reason.c_str());
}

void print_result(const CalibrationRun& run)
{
    const calibration::StereoCalibration& c = run.calibration;
    const calibration::Quality& q = run.quality;
    std::printf("\n%d of %zu pairs, %d x %d px: RMS %.3f px (left %.3f, right %.3f)\n", c.pairs_used, run.pairs.size(),
                c.rig.width, c.rig.height, c.rms_px, c.rms_left_px, c.rms_right_px);
    std::printf("rows of left and right miss each other by %.3f px RMS, 95 %% by less than %.3f px\n",
                q.epipolar_rms_px, q.epipolar_p95_px);
    std::printf("boards that were held out (%d): shape off by %.2f mm, distance by %.2f mm\n", q.held_out_pairs,
                q.held_out_mm, q.held_out_depth_mm);
    std::printf("depth error to expect:");
    for (const calibration::DepthError& d : q.depth)
        std::printf("%s +- %.2f mm at %.0f mm", &d == q.depth.data() ? "" : ",", d.calibration_mm, d.distance_mm);
    std::printf("\ncorners cover %.0f %% of the left picture, %.0f %% of the right one, at %.0f to %.0f mm\n",
                100 * q.left.share, 100 * q.right.share, q.nearest_mm, q.farthest_mm);
    std::printf("boards in the working range, %.0f to %.0f mm: %d near, %d middle, %d far\n", run.range.near_mm,
                run.range.far_mm, q.boards_by_distance[0], q.boards_by_distance[1], q.boards_by_distance[2]);
    for (const auto& [side, lens] : {std::pair{"left", &c.rig.left}, std::pair{"right", &c.rig.right}})
        std::printf("%-5s fx %.2f  fy %.2f  cx %.2f  cy %.2f px\n", side, lens->fx, lens->fy, lens->cx, lens->cy);
    std::printf("T %.3f %.3f %.3f mm, baseline %.3f mm\n", c.rig.shift_mm.x, c.rig.shift_mm.y, c.rig.shift_mm.z,
                c.rig.baseline_mm());
    if (run.task.fit_warp)
        std::printf("bow of the board: %.3f mm along its columns, %.3f mm along its rows\n", c.warp_mm[0],
                    c.warp_mm[1]);
    std::printf("\nverdict: %s\n", name_of(q.verdict));
    for (const std::string& advice : q.advice)
        std::printf("  - %s\n", advice.c_str());
}

json json_of(const Lens& lens)
{
    return {{"fx_px", lens.fx},
            {"fy_px", lens.fy},
            {"cx_px", lens.cx},
            {"cy_px", lens.cy},
            {"distortion", std::vector<double>(lens.k.begin(), lens.k.begin() + 5)}};
}

json json_of(const CalibrationRun& run, const SeenPair& pair)
{
    json one = {{"left", pair.left_path},
                {"right", pair.right_path},
                {"left_found", pair.left.found},
                {"right_found", pair.right.found},
                {"used", run.solved && pair.rejected.empty()},
                {"reason", pair.rejected}};
    if (pair.board >= 0)
        one["board"] = pair.board;
    if (const calibration::ViewOutcome* outcome = outcome_of(run, pair); outcome != nullptr && outcome->used) {
        if (pair.left.found)
            one["rms_left_px"] = outcome->rms_left_px;
        if (pair.right.found)
            one["rms_right_px"] = outcome->rms_right_px;
        one["distance_mm"] = outcome->shift_mm.z;
    }
    return one;
}

json json_of(const CalibrationRun& run, const calibration::Quality& q)
{
    json depth = json::array();
    for (const calibration::DepthError& d : q.depth)
        depth.push_back(
            {{"distance_mm", d.distance_mm}, {"calibration_mm", d.calibration_mm}, {"corner_mm", d.corner_mm}});
    return {{"verdict", name_of(q.verdict)},
            {"advice", q.advice},
            {"epipolar_rms_px", q.epipolar_rms_px},
            {"epipolar_p95_px", q.epipolar_p95_px},
            {"held_out_mm", q.held_out_mm},
            {"held_out_depth_mm", q.held_out_depth_mm},
            {"held_out_size_percent", q.held_out_size_percent},
            {"held_out_pairs", q.held_out_pairs},
            {"depth_error", depth},
            {"coverage_left", q.left.share},
            {"coverage_right", q.right.share},
            {"nearest_mm", q.nearest_mm},
            {"farthest_mm", q.farthest_mm},
            {"near_mm", run.range.near_mm},
            {"far_mm", run.range.far_mm},
            {"boards_by_distance", q.boards_by_distance}};
}

} // namespace

void print_run(const CalibrationRun& run)
{
    print_pairs(run);
    if (run.solved)
        print_result(run);
    else
        std::printf("\nverdict: %s\n", name_of(calibration::Verdict::kRedo));
}

json as_json(const CalibrationRun& run)
{
    json report = {{"width", run.task.width}, {"height", run.task.height}, {"solved", run.solved}};
    report["boards"] = json::array();
    for (const calibration::Board& board : run.task.boards)
        report["boards"].push_back({{"columns", board.cols}, {"rows", board.rows}, {"square_mm", board.square_mm}});
    report["pairs"] = json::array();
    for (const SeenPair& pair : run.pairs)
        report["pairs"].push_back(json_of(run, pair));
    report["alone"] = json::array();
    for (const LonePicture& lone : run.alone)
        report["alone"].push_back({{"picture", lone.name}, {"reason", lone.reason}});
    report["found_s"] = run.finding_s;
    if (!run.solved) {
        report["verdict"] = name_of(calibration::Verdict::kRedo);
        report["advice"] = run.quality.advice;
        return report;
    }
    const calibration::StereoCalibration& c = run.calibration;
    report.update({{"solved_s", run.solving_s},
                   {"pairs_used", c.pairs_used},
                   {"rms_px", c.rms_px},
                   {"rms_left_px", c.rms_left_px},
                   {"rms_right_px", c.rms_right_px},
                   {"corner_deviation_px", c.sigma_px},
                   {"left", json_of(c.rig.left)},
                   {"right", json_of(c.rig.right)},
                   {"rotation", *run.rig.rotation},
                   {"translation_mm", *run.rig.translation_mm},
                   {"baseline_mm", c.rig.baseline_mm()},
                   {"id", run.rig.id},
                   {"calibrated_at", run.rig.calibrated_at}});
    if (run.task.fit_warp)
        report["warp_mm"] = c.warp_mm;
    report.update(json_of(run, run.quality));
    return report;
}

} // namespace dicot::app
