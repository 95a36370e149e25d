// The words that every command which matches understands, and what they mean.
#pragma once

#include "command.h"
#include "config/config.h"
#include "dicot/kernels/kernels.h"
#include "dicot/matching/matcher.h"

#include <string>

namespace dicot::app {

/// Method, cost, window, weights, threads and CPU level as given on the command line or in the configuration.
struct MatchWords
{
    MatchOptions options;
    std::string method = MatchingConfig{}.method;
    std::string cost = MatchingConfig{}.cost;
    std::string cpu = MatchingConfig{}.cpu;
    int threads = MatchingConfig{}.threads; ///< 0: one for each processor that this process may use

    MatchWords() = default;
    explicit MatchWords(const MatchingConfig& config);

    void add_to(CLI::App& command);
    /// For commands that choose the number of threads themselves.
    void add_all_but_threads_to(CLI::App& command);

    /// The options with method and cost filled in.
    MatchOptions resolved() const;
    int resolved_threads() const;
};

/// The kernels for "auto", "scalar", "avx2" or "neon".
/// Errors: kUnavailable when this CPU or this build has none of that name.
Result<const Kernels*> choose_kernels(const std::string& cpu);

} // namespace dicot::app
