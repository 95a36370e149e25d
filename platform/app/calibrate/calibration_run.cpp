#include "calibration_run.h"

#include "../progress.h"
#include "../rectify_rig.h"
#include "seen_picture.h"

#include "dicot/os/clock.h"
#include "dicot/os/shown_path.h"
#include "dicot/picture/read_picture.h"
#include "dicot/rig/rig_id.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

namespace dicot::app {
namespace {

using calibration::Board;
using calibration::BoardSight;

std::string last_part(const std::string& folder)
{
    return folder.substr(folder.rfind('/') + 1);
}

/// All folders, for the beginning of a sentence.
std::string folders_of(const CalibrationPlan& plan)
{
    std::string names;
    for (const PictureSet& set : plan.sets)
        names += (names.empty() ? "" : ", ") + shown_name(plan.sets.size() == 1 ? set.folder : last_part(set.folder));
    return names.substr(0, 150);
}

/// Refuses pictures of different sizes; those without a readable head are judged later.
Status take_size(CalibrationRun& run)
{
    std::map<std::pair<int, int>, int> counts;
    std::vector<std::pair<const std::string*, std::pair<int, int>>> sizes;
    for (const SeenPair& pair : run.pairs)
        for (const std::string* path : {&pair.left_path, &pair.right_path})
            if (const auto size = picture_size(path->c_str()); size.ok()) {
                const std::pair<int, int> sides{size.value().width, size.value().height};
                ++counts[sides];
                sizes.emplace_back(path, sides);
            }
    if (sizes.empty())
        return {};
    const auto usual = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
                           return a.second < b.second;
                       })->first;
    for (const auto& [path, sides] : sizes)
        if (sides != usual)
            return failure(Fault::kBadData,
                           "%s is %d x %d px, other pictures are %d x %d: calibrate with pictures of one size, the "
                           "size that the cameras will work at",
                           shown_path(path->c_str()), sides.first, sides.second, usual.first, usual.second);
    run.task.width = usual.first;
    run.task.height = usual.second;
    return {};
}

int board_index(std::vector<Board>& boards, const Board& board)
{
    const auto found = std::find(boards.begin(), boards.end(), board);
    if (found == boards.end())
        boards.push_back(board);
    return static_cast<int>(std::find(boards.begin(), boards.end(), board) - boards.begin());
}

/// The most frequent reason of all pictures.
std::string usual_reason(const std::vector<SeenPicture>& pictures)
{
    std::map<std::string, int> counts;
    for (const SeenPicture& picture : pictures)
        ++counts[picture.reason()];
    return std::max_element(counts.begin(), counts.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

/// Chooses the board that both pictures show, else one that one of them shows, and gives the solver what there is.
void join(SeenPair& pair, SeenPicture& left, SeenPicture& right, calibration::CalibrationTask& task)
{
    const std::size_t boards = left.boards.size();
    std::size_t chosen = 0;
    int best = 0;
    for (std::size_t k = 0; k < boards; ++k) {
        const int found = (left.found(k) ? 1 : 0) + (right.found(k) ? 1 : 0);
        if (found > best) {
            best = found;
            chosen = k;
        }
    }
    if (!left.found(chosen))
        pair.rejected = left.name + ": " + left.reason();
    if (!right.found(chosen))
        pair.rejected += (pair.rejected.empty() ? "" : "; ") + right.name + ": " + right.reason();
    if (best == 0)
        return;
    pair.board = left.boards[chosen];
    if (left.found(chosen))
        pair.left = std::move(left.sights[chosen]);
    if (right.found(chosen))
        pair.right = std::move(right.sights[chosen]);
    if (best == 2) {
        const Status order =
            calibration::agree_on_order(task.boards[static_cast<std::size_t>(pair.board)], pair.left, pair.right);
        if (!order.ok()) {
            pair.rejected = order.message();
            return;
        }
    }
    // A board that one camera saw helps that camera's lens.
    pair.view = static_cast<int>(task.views.size());
    task.views.push_back({pair.board, pair.left.corners, pair.right.corners});
}

Status find_boards(const CalibrationPlan& plan, CalibrationRun& run, Crew& crew)
{
    std::vector<SeenPicture> pictures;
    for (const SeenPair& pair : run.pairs) {
        std::vector<int> boards;
        for (const Board& board : plan.sets[static_cast<std::size_t>(pair.set)].boards)
            boards.push_back(board_index(run.task.boards, board));
        pictures.emplace_back(pair.left_name, pair.left_path, boards);
        pictures.emplace_back(pair.right_name, pair.right_path, std::move(boards));
    }
    const auto all = static_cast<int>(pictures.size());
    {
        Progress progress("finding boards");
        std::atomic<int> done{0};
        crew.run(all, [&](int index) {
            pictures[static_cast<std::size_t>(index)].look(run.task.boards);
            progress.done(++done, all);
        });
    }
    const bool any = std::any_of(pictures.begin(), pictures.end(), [](const SeenPicture& p) { return p.any_found(); });
    const std::string usual = usual_reason(pictures);
    for (std::size_t k = 0; k < run.pairs.size(); ++k)
        join(run.pairs[k], pictures[2 * k], pictures[2 * k + 1], run.task);
    if (!any)
        return failure(Fault::kBadData, "no board found in any of %d pictures; most of them: %s", all, usual.c_str());
    return {};
}

void fill_rig(const CalibrationPlan& plan, CalibrationRun& run)
{
    const calibration::StereoCalibration& c = run.calibration;
    RigFile& rig = run.rig;
    rig.width = c.rig.width;
    rig.height = c.rig.height;
    for (const auto& [camera, lens] : {std::pair{&rig.left, &c.rig.left}, std::pair{&rig.right, &c.rig.right}}) {
        camera->intrinsic = {{{lens->fx, 0, lens->cx}, {0, lens->fy, lens->cy}, {0, 0, 1}}};
        Distortion distortion;
        distortion.count = 5;
        std::copy_n(lens->k.begin(), 5, distortion.at.begin());
        camera->distortion = distortion;
    }
    Matrix<3, 3> turn{};
    for (std::size_t i = 0; i < 9; ++i)
        turn[i / 3][i % 3] = c.rig.turn[i];
    rig.rotation = turn;
    rig.translation_mm = {c.rig.shift_mm.x, c.rig.shift_mm.y, c.rig.shift_mm.z};
    rig.near_mm = plan.range.near_mm;
    rig.far_mm = plan.range.far_mm;

    const calibration::Quality& q = run.quality;
    RigQuality quality;
    std::snprintf(quality.verdict, sizeof quality.verdict, "%s", name_of(q.verdict));
    quality.pairs = c.pairs_used;
    quality.rms_px = c.rms_px;
    quality.epipolar_rms_px = q.epipolar_rms_px;
    quality.epipolar_p95_px = q.epipolar_p95_px;
    quality.held_out_mm = q.held_out_mm;
    quality.held_out_depth_mm = q.held_out_depth_mm;
    for (std::size_t k = 0; k < RigQuality::kDepthsMm.size(); ++k)
        quality.depth_error_mm[k] = calibration::predict_depth_error(c, RigQuality::kDepthsMm[k]).calibration_mm;
    quality.nearest_mm = q.nearest_mm;
    quality.farthest_mm = q.farthest_mm;
    rig.quality = quality;
}

bool all_finite(const RigQuality& q)
{
    double sum = q.rms_px + q.epipolar_rms_px + q.epipolar_p95_px + q.held_out_mm + q.held_out_depth_mm + q.nearest_mm +
                 q.farthest_mm;
    for (const double error : q.depth_error_mm)
        sum += error;
    return std::isfinite(sum);
}

Status solve(const CalibrationPlan& plan, CalibrationRun& run)
{
    run.task.fit_k3 = plan.fit_k3;
    run.task.fit_warp = plan.fit_warp;
    run.calibration = TRY(calibration::solve_stereo(run.task));
    for (SeenPair& pair : run.pairs) {
        const auto& outcome = run.calibration.views;
        if (pair.view >= 0 && !outcome[static_cast<std::size_t>(pair.view)].used)
            pair.rejected += (pair.rejected.empty() ? "" : "; ") + outcome[static_cast<std::size_t>(pair.view)].reason;
    }
    run.range = plan.range;
    run.quality = assess(run.task, run.calibration, plan.range);
    fill_rig(plan, run);
    if (!all_finite(*run.rig.quality))
        return failure(Fault::kBadData,
                       "the pictures do not determine the cameras: take more pairs, the board tilted by "
                       "20 to 40 degrees to all four sides, near and far");
    set_rectification(run.rig, TRY(rectify(run.calibration.rig, kCrop, "the calibrated cameras")));
    set_id(run.rig);
    return {};
}

} // namespace

Status list_pairs(const CalibrationPlan& plan, CalibrationRun& run)
{
    for (std::size_t s = 0; s < plan.sets.size(); ++s) {
        const std::string& folder = plan.sets[s].folder;
        PairedNames names = TRY(pairs_in_folder(folder));
        const auto namesakes = std::ranges::count(plan.sets, last_part(folder),
                                                  [](const PictureSet& set) { return last_part(set.folder); });
        const std::string prefix = plan.sets.size() == 1 ? "" : (namesakes > 1 ? folder : last_part(folder)) + "/";
        for (const PicturePair& names_of_pair : names.pairs) {
            SeenPair pair;
            pair.set = static_cast<int>(s);
            pair.left_name = shown_name(prefix + names_of_pair.left);
            pair.right_name = shown_name(prefix + names_of_pair.right);
            pair.name = pair.left_name + " and " + pair.right_name;
            pair.left_path = folder + "/" + names_of_pair.left;
            pair.right_path = folder + "/" + names_of_pair.right;
            run.pairs.push_back(std::move(pair));
        }
        for (const LonePicture& lone : names.alone)
            run.alone.push_back({shown_name(prefix + lone.name), shown_name(lone.reason)});
    }
    return take_size(run);
}

Status calibrate(const CalibrationPlan& plan, CalibrationRun& run, Crew& crew)
{
    const std::int64_t start_us = monotonic_us();
    Status outcome = find_boards(plan, run, crew);
    const std::int64_t found_us = monotonic_us();
    run.finding_s = static_cast<double>(found_us - start_us) * 1e-6;
    if (outcome.ok())
        outcome = solve(plan, run);
    run.solving_s = static_cast<double>(monotonic_us() - found_us) * 1e-6;
    run.solved = outcome.ok();
    if (run.solved)
        return {};
    run.calibration = {};
    run.quality = {};
    run.quality.advice = {outcome.message()};
    return failure(outcome.fault(), "%s: %s", folders_of(plan).c_str(), outcome.message());
}

} // namespace dicot::app
