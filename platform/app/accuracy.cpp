// dicot accuracy: targets at known distances, and how far away this rig sees them.
#include "accuracy/depth_report.h"
#include "accuracy/depth_run.h"
#include "accuracy/depth_words.h"
#include "commands.h"
#include "distinct_files.h"
#include "output_folder.h"

#include "dicot/os/output_file.h"
#include "dicot/os/shown_path.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <unistd.h>

namespace dicot::app {
namespace {

constexpr const char* kAboutAccuracy =
    "Photograph a flat, textured target (a box with printed paper) at several known distances, parallel to the "
    "left picture. A distance is measured in mm from the left camera's projection centre, along its optical axis.\n\n"
    "What DIR holds:\n"
    " - pairs, named as 'dicot calibrate' wants them. A name tells its distance: box_0488_left.jpg, or, where it has "
    "several numbers, shot3_488mm_left.jpg or shot3_48.8cm_left.jpg;\n"
    " - or, in place of that, a table (.csv) with the columns distance_mm and name (how the pair's names begin), or "
    "distance_mm, left and right (the names of both pictures). Further columns that are used where they are there:\n"
    "   left_tl_u left_tl_v left_tr_u ... left_bl_v: the target's four corners, px of the left picture as the camera "
    "gave it; the inner 80 % of its width and height are measured;\n"
    "   normal_x normal_y normal_z centre_x_mm centre_y_mm centre_z_mm: its plane in the left camera's frame, when it "
    "is slanted.\n\n"
    "Measured is --box where it is given, else the inside of the corners, else the middle twelfth of the picture: "
    "there the target must be. "
    "Reported for each target: the median depth over it, its error, the bound of eq. 21 of the 2017 paper, "
    "Z^2 / (f B) x 0.5 px, within how many mm half and 95 % of its pixels lie, and the share that has a value.";

struct AccuracyWords
{
    DepthWords depth;
    std::string box, csv, report;
    bool json = false;
};

Result<TargetBox> box_of(const std::string& text)
{
    TargetBox box{};
    int used = -1;
    if (std::sscanf(text.c_str(), "%d,%d,%d,%d%n", &box[0], &box[1], &box[2], &box[3], &used) != 4 ||
        used != static_cast<int>(text.size()))
        return failure(Fault::kUsage,
                       "--box %.60s: give four whole numbers, as 600,330,80,60: left, top, width, height",
                       text.c_str());
    return box;
}

/// A table beside the pairs would tell the next run its distances.
Status check_elsewhere(const std::string& csv, const std::string& folder)
{
    const std::filesystem::path parent = std::filesystem::path(csv).parent_path();
    std::error_code none; // a folder that is not there is refused by whoever reads it
    if (std::filesystem::equivalent(parent.empty() ? "." : parent, folder, none))
        return failure(Fault::kUsage,
                       "%s: the next run would take it for the table of distances: name a file outside "
                       "of %s",
                       shown_path(csv.c_str()), shown_path(folder.c_str()));
    return {};
}

/// What was measured has been told; a target without a depth is an input that did not fit all the same.
Status check_all_measured(const DepthRun& found)
{
    const int lost = static_cast<int>(found.readings.size()) - found.measured();
    if (lost == 0)
        return {};
    const auto first = std::ranges::find_if(found.readings, [](const DepthReading& r) { return !r.measured(); });
    return failure(Fault::kBadData, "%d of %zu targets gave no depth; the first one: %.300s", lost,
                   found.readings.size(), first->lost.c_str());
}

Status run(AccuracyWords words)
{
    if (!words.box.empty())
        words.depth.targets.box = TRY(box_of(words.box));
    TRY(check_distinct({words.depth.rig, words.depth.targets.table}, {words.csv}));
    // Its files would be among the next run's inputs.
    TRY(check_distinct({words.depth.targets.folder}, {words.report}));
    if (!words.csv.empty()) {
        TRY(check_elsewhere(words.csv, words.depth.targets.folder));
        OutputFile can_be_written;
        TRY(can_be_written.open(words.csv.c_str()));
    }
    std::error_code none;
    const bool makes_report = !words.report.empty() && !std::filesystem::exists(words.report, none);
    if (!words.report.empty())
        TRY(make_folder(words.report)); // now rather than after minutes
    Result<DepthRun> outcome = run_depths(words.depth);
    if (!outcome.ok() && makes_report)
        (void)::rmdir(words.report.c_str());
    const DepthRun found = TRY(std::move(outcome));
    if (!words.csv.empty()) {
        const std::string text = as_csv(found);
        OutputFile file;
        TRY(file.open(words.csv.c_str()));
        TRY(file.write(text.data(), text.size()));
        TRY(file.commit());
    }
    if (!words.report.empty())
        TRY(write_depth_report(found, words.depth, words.report));
    if (words.json) {
        nlohmann::json report = as_json(found, words.depth);
        if (!words.report.empty())
            report["report"] = words.report;
        std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
        return check_all_measured(found);
    }
    print_run(found, words.depth);
    if (!words.report.empty())
        std::printf("%s/index.html: the report\n", words.report.c_str());
    return check_all_measured(found);
}

} // namespace

void add_accuracy(CLI::App& program, Command& chosen)
{
    CLI::App* command =
        program.add_subcommand("accuracy", "Errors of measured depth from pictures of a target at known distances");
    command->footer(kAboutAccuracy);
    auto words = std::make_shared<AccuracyWords>();
    words->depth.match.method = "best";
    command->add_option("DIR", words->depth.targets.folder, "folder of the pairs, see below")->required();
    command->add_option("--rig", words->depth.rig, "rig file of the two cameras (YAML)")->required();
    command->add_option("--table", words->depth.targets.table,
                        "table of the distances (default: the one in DIR with a column distance_mm)");
    command->add_option("--box", words->box,
                        "X,Y,W,H: a part of the target in every left picture as the camera gave it, px");
    command->add_option("--near-mm", words->depth.near_mm,
                        "nearest distance of the search (default: the rig file's, and nearer than all targets)");
    command->add_option("--far-mm", words->depth.far_mm,
                        "farthest distance of the search (default: the rig file's, and beyond all targets)");
    command->add_flag("--whole", words->depth.whole, "match whole pictures, not the part around the target alone");
    words->depth.match.add_to(*command);
    command->add_option("-o,--output", words->csv, "the table of the results, .csv");
    command->add_option("--report", words->report, "folder for a page, its plot (.svg) and the table (.csv)");
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
