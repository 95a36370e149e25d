#include "match_words.h"

#include "dicot/os/cpu.h"
#include "dicot/os/thread_crew.h"

#include <algorithm>

namespace dicot::app {

MatchWords::MatchWords(const MatchingConfig& config)
    : method(config.method), cost(config.cost), cpu(config.cpu), threads(config.threads)
{
    options.window = config.window;
    options.gamma_color = config.gamma_color;
    options.gamma_space = config.gamma_space;
}

void MatchWords::add_to(CLI::App& command)
{
    add_all_but_threads_to(command);
    command.add_option("--threads", threads, "worker threads; 0: one for each processor. Never changes the result")
        ->check(CLI::Range(0, ThreadCrew::kMaxThreads))
        ->capture_default_str();
}

void MatchWords::add_all_but_threads_to(CLI::App& command)
{
    command
        .add_option("--method", method,
                    "paper: the published equations alone; standard: checked and refined; "
                    "fast: a little less exact, a seventh of its time; best: the most exact, twice its time")
        ->check(CLI::IsMember({"paper", "fast", "standard", "best"}))
        ->capture_default_str();
    command.add_option("--cost", cost, "matching cost: AD-Census, or truncated absolute differences")
        ->check(CLI::IsMember({"adcensus", "tad"}))
        ->capture_default_str();
    command.add_option("--window", options.window, "support window, px, odd, 3 to 35")->capture_default_str();
    command.add_option("--gamma-color", options.gamma_color, "colour tolerance of the support weights, CIELAB units")
        ->capture_default_str();
    command.add_option("--gamma-space", options.gamma_space, "reach of the support weights, px")->capture_default_str();
    command.add_option("--cpu", cpu, "instruction set. Never changes the result")
        ->check(CLI::IsMember({"auto", "scalar", "avx2", "neon"}))
        ->capture_default_str();
}

MatchOptions MatchWords::resolved() const
{
    MatchOptions resolved = options;
    resolved.method = method == "paper"  ? MatchMethod::kPaper
                      : method == "fast" ? MatchMethod::kFast
                      : method == "best" ? MatchMethod::kBest
                                         : MatchMethod::kStandard;
    resolved.cost = cost == "tad" ? MatchCost::kTad : MatchCost::kAdCensus;
    return resolved;
}

int MatchWords::resolved_threads() const
{
    return threads > 0 ? threads : std::min(ThreadCrew::processors(), ThreadCrew::kMaxThreads);
}

Result<const Kernels*> choose_kernels(const std::string& cpu)
{
    const CpuFeatures features = cpu_features();
    const auto usable = [](CpuLevel level, bool present) { return present ? kernels_for(level) : nullptr; };
    const Kernels* avx2 = usable(CpuLevel::kAvx2, features.avx2);
    const Kernels* neon = usable(CpuLevel::kNeon, features.neon);
    const Kernels* chosen = &kScalarKernels;
    if (cpu == "auto")
        chosen = avx2 ? avx2 : neon ? neon : &kScalarKernels;
    else if (cpu == "avx2")
        chosen = avx2;
    else if (cpu == "neon")
        chosen = neon;
    if (chosen == nullptr)
        return failure(Fault::kUnavailable, "this computer has no %s: leave --cpu away, or choose --cpu scalar",
                       cpu.c_str());
    return chosen;
}

} // namespace dicot::app
