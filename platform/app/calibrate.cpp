// dicot calibrate: pictures of a chessboard in, the geometry of the two cameras out.
#include "calibrate/board_words.h"
#include "calibrate/calibration_date.h"
#include "calibrate/calibration_run.h"
#include "calibrate/calibration_words.h"
#include "calibrate/live/live_options.h"
#include "calibrate/report.h"
#include "commands.h"
#include "distinct_files.h"
#include "output_folder.h"
#include "stored_maps.h"

#include "dicot/os/clock.h"
#include "dicot/os/output_file.h"
#include "dicot/os/process_memory.h"
#include "dicot/os/thread_crew.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <unistd.h>
#include <vector>

namespace dicot::app {
namespace {

struct CalibrateWords
{
    std::vector<BoardWord> boards; ///< filled from the options below, in their order
    std::vector<std::string> images, corners, squares, square_mm;
    CalibrationPlan plan;
    LiveOptions live;
    std::string output, report;
    int threads = 0;
    bool force = false;
    bool json = false;
};

/// Nothing stands beside a pipe or a device.
bool takes_tables(const std::string& output)
{
    std::error_code error;
    return !std::filesystem::exists(output, error) || std::filesystem::is_regular_file(output, error);
}

/// Looks at the outputs before the work.
Status check(const CalibrateWords& words, const CalibrationRun& run)
{
    for (const SeenPair& pair : run.pairs)
        TRY(check_distinct({pair.left_path, pair.right_path}, {words.output, maps_path(words.output)}));
    const auto folder_of = [](const std::string& path) { return std::filesystem::path(path).parent_path().string(); };
    for (const SeenPair& pair : run.pairs) // its pictures would be the next run's
        TRY(check_distinct({folder_of(pair.left_path), folder_of(pair.right_path)}, {words.report}));
    if (words.output.ends_with(".maps"))
        return failure(Fault::kUsage, "%s: that is the name of a rig's tables: end the rig file's name in .yaml",
                       words.output.c_str());
    OutputFile rig_can_be_written;
    TRY(rig_can_be_written.open(words.output.c_str()));
    if (takes_tables(words.output)) {
        OutputFile tables_can_be_written;
        TRY(tables_can_be_written.open(maps_path(words.output).c_str()));
    }
    return words.report.empty() ? Status{} : make_folder(words.report);
}

bool several_boards(const CalibrationPlan& plan)
{
    const calibration::Board& first = plan.sets.front().boards.front();
    return std::ranges::any_of(plan.sets, [&](const PictureSet& set) {
        return std::ranges::any_of(set.boards, [&](const calibration::Board& board) { return !(board == first); });
    });
}

/// What a verdict of redo says about the rig file.
Status refuse_redo(const CalibrateWords& words, const CalibrationRun& run)
{
    if (run.quality.verdict != calibration::Verdict::kRedo || words.force)
        return {};
    return failure(
        Fault::kBadData, "%.100s is not written, for the verdict is redo: %s (or write it all the same with --force)",
        words.output.c_str(), run.quality.advice.empty() ? "take new pictures" : run.quality.advice.front().c_str());
}

std::string page_in(const std::string& folder)
{
    return folder + "/index.html";
}

bool is_there(const std::string& path)
{
    return ::access(path.c_str(), F_OK) == 0;
}

struct Written
{
    bool rig = false;
    bool page = false;
    std::string maps; ///< the stored tables' path; empty when not written
    Status outcome;   ///< of the whole command
};

/// The page first: should that fail, the rig file is still the former one. Its tables last: without them, or with
/// those of the former rig, they are built when they are needed. A refused run replaces nothing: its page is
/// written only where none stands.
Written write_outputs(const CalibrateWords& words, const CalibrationRun& run, const Status& calibrated)
{
    Written written;
    written.outcome = calibrated.ok() ? refuse_redo(words, run) : calibrated;
    if (!words.report.empty() && (written.outcome.ok() || !is_there(page_in(words.report)))) {
        const Status reported = write_report(run, words.report);
        written.page = reported.ok();
        if (written.outcome.ok())
            written.outcome = reported;
    }
    if (written.outcome.ok())
        written.outcome = write_rig_file(words.output.c_str(), run.rig);
    written.rig = written.outcome.ok();
    if (written.rig && takes_tables(words.output)) {
        const std::string maps = maps_path(words.output);
        const Status stored = store_tables(run.rig, kCrop, words.output, maps).status();
        if (stored.ok())
            written.maps = maps;
        else
            std::fprintf(stderr, "dicot: %s; the tables will be built whenever they are needed\n", stored.message());
    }
    return written;
}

Status tell(const CalibrateWords& words, const CalibrationRun& run, int threads, const Written& written)
{
    const ProcessMemory memory = TRY(process_memory());
    if (words.json) {
        nlohmann::json json = as_json(run);
        json["output"] = words.output;
        json["written"] = written.rig;
        if (!words.report.empty()) {
            json["report"] = words.report;
            json["report_written"] = written.page;
        }
        if (!written.maps.empty())
            json["tables"] = written.maps;
        json["refused"] = written.outcome.message();
        json["threads"] = threads;
        json["processor_s"] = static_cast<double>(process_cpu_us()) * 1e-6;
        json["peak_memory_bytes"] = memory.peak_bytes;
        // Names of files may be any bytes.
        std::printf("%s\n",
                    json.dump(words.live.on ? -1 : 2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    } else {
        print_run(run);
        std::printf("\nboards found in %.2f s, solved in %.2f s (%d thread%s), peak memory %.1f MiB\n", run.finding_s,
                    run.solving_s, threads, threads == 1 ? "" : "s",
                    static_cast<double>(memory.peak_bytes) / (1 << 20));
        if (written.page)
            std::printf("%s: the report\n", page_in(words.report).c_str());
        else if (!words.report.empty() && is_there(page_in(words.report)))
            std::printf("%s: that of an earlier run stays\n", page_in(words.report).c_str());
        if (written.rig)
            std::printf("%s: written, %s\n", words.output.c_str(), run.rig.id);
        if (!written.maps.empty())
            std::printf("%s: its rectification tables\n", written.maps.c_str());
    }
    std::fflush(stdout); // before the sentence on stderr
    return {};
}

/// The outputs are looked at before somebody holds boards for nothing.
Status take_pairs_first(const CalibrateWords& words, const CalibrationPlan& plan, Crew& crew)
{
    TRY(check_distinct({plan.sets.front().folder}, {words.report}));
    const bool makes_report = !words.report.empty() && !is_there(words.report);
    Status outcome = check(words, {});
    if (outcome.ok())
        outcome = take_pairs(live_plan(words.live, plan, words.output, words.json), crew);
    if (!outcome.ok() && makes_report)
        (void)::rmdir(words.report.c_str());
    return outcome;
}

Status run(const CalibrateWords& words)
{
    CalibrationPlan plan = words.plan;
    if (!words.live.on)
        TRY(words.live.refuse_without_live());
    plan.sets = TRY(words.live.on ? read_live_words(words.boards, words.output) : read_board_words(words.boards));
    if (!(plan.range.near_mm > 0 && plan.range.near_mm < plan.range.far_mm && plan.range.far_mm <= 1e6))
        return failure(Fault::kUsage, "--near-mm must be above 0 and below --far-mm, which is 1000000 at most");
    if (plan.fit_warp && several_boards(plan))
        return failure(Fault::kUsage, "--fit-warp finds the bow of one board: calibrate with one board alone");
    CalibrationRun run;
    const int threads = words.threads > 0 ? words.threads : std::min(ThreadCrew::processors(), ThreadCrew::kMaxThreads);
    ThreadCrew crew(threads);
    TRY(crew.started());
    if (words.live.on)
        TRY(take_pairs_first(words, plan, crew));
    TRY(date_rig(run.rig));
    TRY(list_pairs(plan, run));
    TRY(check(words, run));

    const Status calibrated = calibrate(plan, run, crew);
    const Written written = write_outputs(words, run, calibrated);
    TRY(tell(words, run, threads, written));
    return written.outcome;
}

} // namespace

void add_calibrate(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("calibrate", "Two cameras' geometry from pictures of a chessboard");
    auto words = std::make_shared<CalibrateWords>();
    std::map<const CLI::Option*, std::pair<BoardWord::Kind, const std::vector<std::string>*>> ordered;
    const auto add = [&](const char* name, BoardWord::Kind kind, std::vector<std::string>& values, const char* what) {
        constexpr std::array<const char*, 4> kTypes{"DIR", "CxR", "CxR", "MM"};
        ordered[command->add_option(name, values, what)->allow_extra_args(false)->type_name(kTypes[kind])] = {kind,
                                                                                                              &values};
    };
    add("--images", BoardWord::kImages, words->images,
        "folder of pairs: left01.jpg and right01.jpg, 0001_left.png and 0001_right.png, or left/ and right/");
    add("--corners", BoardWord::kCorners, words->corners, "inner corners of the board, columns x rows, like 9x6");
    add("--squares", BoardWord::kSquares, words->squares, "the same counted in squares: 10x7 has 9x6 corners");
    add("--square-mm", BoardWord::kSquareMm, words->square_mm, "side of one square, mm");
    add_live_options(*command, words->live);
    command->add_option("-o,--output", words->output, "rig file (YAML)")->required();
    command->add_option("--report", words->report, "folder for a page about it: index.html and its pictures");
    command->add_option("--near-mm", words->plan.range.near_mm, "where the plants begin")->capture_default_str();
    command->add_option("--far-mm", words->plan.range.far_mm, "where they end")->capture_default_str();
    command->add_flag("--fit-k3", words->plan.fit_k3, "fit the third radial distortion too, for wide lenses");
    command->add_flag("--fit-warp", words->plan.fit_warp,
                      "fit a bow of the board, for one that is not flat; one board only");
    command
        ->add_option("--threads", words->threads, "worker threads; 0: one for each processor. Never changes the result")
        ->check(CLI::Range(0, ThreadCrew::kMaxThreads))
        ->capture_default_str();
    command->add_flag("--force", words->force, "write the rig file even if the verdict is redo");
    command->add_flag("--json", words->json, "report as JSON");
    command->footer(
        "Several boards: name each folder and then its board,\n"
        "  --images A --corners 9x9 --square-mm 41 --images B --corners 7x7 --square-mm 46\n"
        "Folders that stand together share the boards behind them; boards before all folders belong to every folder. "
        "A\n"
        "folder with several boards is searched for each. Exit code 65, and no rig file, when the verdict is redo.\n"
        "With --live the pairs come from the cameras: one folder at most, new or empty, one board.");
    command->callback([words, command, ordered, &chosen] {
        std::map<const CLI::Option*, std::size_t> taken;
        for (const CLI::Option* option : command->parse_order())
            if (const auto found = ordered.find(option); found != ordered.end())
                words->boards.push_back({found->second.first, found->second.second->at(taken[option]++)});
        chosen = [words] { return run(*words); };
    });
}

} // namespace dicot::app
