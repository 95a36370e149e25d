// dicot bench: how fast this computer matches, where the time goes, and how far that is from what its core can do.
#include "bench_loops.h"
#include "bench_rectify.h"
#include "commands.h"
#include "match_bench.h"
#include "match_words.h"
#include "progress.h"

#include "dicot/os/clock.h"
#include "dicot/os/thread_crew.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct BenchWords
{
    MatchWords match;
    int width = 640;
    int height = 480;
    int rounds = 3;
    bool json = false;
};

struct MatchRun
{
    double seconds = 0;     ///< on the wall
    double cpu_seconds = 0; ///< of all threads: other programs do not count
    double terms_per_cpu_s = 0;
    MatchTimes times;
};

std::uint64_t now_ns()
{
    return static_cast<std::uint64_t>(monotonic_us()) * 1000;
}

/// Noise with a known shift between the pictures: what the pixels say does not change how long matching takes.
void draw(ImageView<Rgb8> left, ImageView<Rgb8> right)
{
    std::uint32_t state = 1;
    const auto next = [&state] {
        state = state * 1664525u + 1013904223u;
        return static_cast<std::uint8_t>(state >> 24);
    };
    for (int y = 0; y < left.height; ++y) {
        for (int x = 0; x < left.width; ++x)
            left.at(x, y) = {next(), next(), next()};
        for (int x = 0; x < left.width; ++x)
            right.at(x, y) = left.at(std::min(x + 10, left.width - 1), y);
    }
}

/// The best of `rounds` runs.
Result<MatchRun> time_match(const BenchWords& words, const Kernels& kernels, int threads)
{
    MatchBench bench = TRY(MatchBench::make(words.width, words.height, words.match.resolved(), kernels, threads));
    draw(bench.left, bench.right);
    ThreadCrew crew(threads);
    TRY(crew.started());
    MatchRun best;
    for (int round = 0; round < words.rounds; ++round) {
        Progress progress("matching");
        const std::int64_t start = monotonic_us();
        const std::int64_t cpu_start = process_cpu_us();
        const MatchOutcome outcome =
            bench.matcher.match(bench.left, bench.right, crew, {now_ns, Progress::rows_done, &progress});
        const double seconds = static_cast<double>(monotonic_us() - start) * 1e-6;
        const double cpu_seconds = static_cast<double>(process_cpu_us() - cpu_start) * 1e-6;
        if (round == 0 || seconds < best.seconds)
            best = {seconds, cpu_seconds, static_cast<double>(bench.matcher.terms()) / cpu_seconds, outcome.times};
    }
    return best;
}

nlohmann::json stages(const MatchTimes& times)
{
    const auto seconds = [](std::uint64_t ns) { return static_cast<double>(ns) * 1e-9; };
    return {{"prepare_s", seconds(times.prepare)}, {"cost_s", seconds(times.cost)},
            {"weights_s", seconds(times.weights)}, {"aggregate_s", seconds(times.aggregate)},
            {"select_s", seconds(times.select)},   {"refine_s", seconds(times.refine)}};
}

Status run(const BenchWords& words)
{
    const Kernels* kernels = TRY(choose_kernels(words.match.cpu));
    const double clock_hz = core_clock_hz();
    const double float_loop = float_loop_terms_per_s();
    const double kernel = kernel_terms_per_s(*kernels);
    const RectifySpeed rectified = TRY(time_rectify(*kernels));
    const RectifySpeed rectified_by_law = TRY(time_rectify(kScalarKernels));
    const MatchRun one = TRY(time_match(words, *kernels, 1));
    const MatchRun two = TRY(time_match(words, *kernels, 2));
    const double peak = peak_terms_per_cycle(*kernels);

    nlohmann::json report = {{"width", words.width},
                             {"height", words.height},
                             {"disparities", words.match.options.disparities},
                             {"window_px", words.match.options.window},
                             {"method", words.match.method},
                             {"kernels", kernels->name},
                             {"processors", ThreadCrew::processors()},
                             {"core_clock_hz", clock_hz},
                             {"float_loop_terms_per_s", float_loop},
                             {"aggregate_terms_per_s", kernel},
                             {"aggregate_terms_per_cycle", kernel / clock_hz},
                             {"one_thread", stages(one.times)},
                             {"two_threads", stages(two.times)},
                             {"aggregate_over_float_loop", kernel / float_loop},
                             {"one_thread_over_float_loop", one.terms_per_cpu_s / float_loop},
                             {"two_threads_over_one", one.seconds / two.seconds}};
    report["one_thread"].update(
        {{"match_s", one.seconds}, {"cpu_s", one.cpu_seconds}, {"terms_per_cpu_s", one.terms_per_cpu_s}});
    report["two_threads"].update(
        {{"match_s", two.seconds}, {"cpu_s", two.cpu_seconds}, {"terms_per_cpu_s", two.terms_per_cpu_s}});
    report["rectify"] = {{"width", RectifySpeed::kWidth},
                         {"height", RectifySpeed::kHeight},
                         {"rounds", RectifySpeed::kRounds},
                         {"pair_ms", rectified.pair_ms},
                         {"pixels_per_s", rectified.pixels_per_s()},
                         {"scalar_pair_ms", rectified_by_law.pair_ms}};
    if (peak > 0)
        report["aggregate_share_of_peak"] = kernel / clock_hz / peak;
    if (words.json) {
        std::printf("%s\n", report.dump(2).c_str());
        return {};
    }

    std::printf("%d x %d px, %d disparities, window %d, method %s, best of %d; a term is one (p, q, d) of eq. 13\n",
                words.width, words.height, words.match.options.disparities, words.match.options.window,
                words.match.method.c_str(), words.rounds);
    std::printf("core clock, from a chain of additions    %8.2f GHz\n", clock_hz * 1e-9);
    std::printf("plain float loop of eq. 13, 35 x 35       %8.2e terms/s\n", float_loop);
    std::printf("aggregate kernel (%s), 35 x 64          %8.2e terms/s, %.1f a cycle", kernels->name, kernel,
                kernel / clock_hz);
    if (peak > 0)
        std::printf(", %.0f %% of what the core could", 100 * kernel / clock_hz / peak);
    std::printf("\n");
    std::printf("rectify 2 x %d x %d colour, warm, median of %d  %6.2f ms (%s), %.0f MPx/s; scalar %.2f ms\n",
                RectifySpeed::kWidth, RectifySpeed::kHeight, RectifySpeed::kRounds, rectified.pair_ms, kernels->name,
                rectified.pixels_per_s() * 1e-6, rectified_by_law.pair_ms);
    const auto line = [&](const char* name, const MatchRun& run) {
        std::printf("%-12s %6.2f s, %.2f s of processor, %8.2e terms/s of processor (prepare %.2f, cost %.2f, weights "
                    "%.2f, aggregate %.2f, select %.2f, "
                    "refine %.2f s)\n",
                    name, run.seconds, run.cpu_seconds, run.terms_per_cpu_s,
                    static_cast<double>(run.times.prepare) * 1e-9, static_cast<double>(run.times.cost) * 1e-9,
                    static_cast<double>(run.times.weights) * 1e-9, static_cast<double>(run.times.aggregate) * 1e-9,
                    static_cast<double>(run.times.select) * 1e-9, static_cast<double>(run.times.refine) * 1e-9);
    };
    line("one thread", one);
    line("two threads", two);
    std::printf("aggregate kernel over the float loop     %8.1f x\n", kernel / float_loop);
    std::printf("one thread, all stages, over the loop    %8.1f x\n", one.terms_per_cpu_s / float_loop);
    std::printf("two threads over one                     %8.2f x\n", one.seconds / two.seconds);
    return {};
}

} // namespace

void add_bench(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("bench", "How fast this computer matches, and where the time goes");
    auto words = std::make_shared<BenchWords>();
    command->add_option("--width", words->width, "picture width, px")->capture_default_str();
    command->add_option("--height", words->height, "picture height, px")->capture_default_str();
    command->add_option("--disparities", words->match.options.disparities, "width of the search range, px")
        ->capture_default_str();
    command->add_option("--rounds", words->rounds, "runs, of which the best counts")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    words->match.add_all_but_threads_to(*command);
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
