// From a rectified pair to a disparity map: AD-Census cost, adaptive support weights, winner-take-all, in integers.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/disparity.h"
#include "dicot/base/image.h"
#include "dicot/base/status.h"
#include "dicot/base/work.h"
#include "dicot/kernels/kernels.h"

#include <cstdint>

namespace dicot {

enum class MatchMethod
{
    kPaper,    ///< equations 6 to 15 and nothing else
    kFast,     ///< kStandard with the window's square taken as rows and a column: a part of the time
    kStandard, ///< the paper's, and a left-right check; with `dense`, filling and medians
    kBest,     ///< what accuracy twice the time of kStandard buys
};

enum class MatchCost
{
    kAdCensus, ///< equations 10 to 12
    kTad,      ///< equation 9: truncated absolute differences
};

/// What a matcher is asked for. The defaults are the one parameter set of the project.
struct MatchOptions
{
    int disparities = 64;  ///< width of the search range, px, 1 .. kMaxDisparities
    int min_disparity = 0; ///< its start, px, may be negative; kBest looks beyond it for what is then no match
    MatchMethod method = MatchMethod::kStandard;
    MatchCost cost = MatchCost::kAdCensus;
    int window = 35;         ///< support window, px, odd, 3 .. kMaxWindow
    double gamma_color = 6;  ///< eq. 6, CIELAB units
    double gamma_space = 17; ///< eq. 6, px
    bool dense = false;      ///< a value for every pixel: what fails a check is filled from its neighbours
    int band_rows = 0;       ///< rows that one worker does in one go; 0: as even as possible. Never changes the result.
};

/// Where the time of one match went, in nanoseconds of the first worker; zero without a clock.
struct MatchTimes
{
    std::uint64_t prepare = 0;   ///< colour conversion, census
    std::uint64_t cost = 0;      ///< match_cost
    std::uint64_t weights = 0;   ///< support_weights
    std::uint64_t aggregate = 0; ///< aggregate
    std::uint64_t select = 0;    ///< division, winners, parabola, left-right check
    std::uint64_t refine = 0;    ///< filling and medians
};

/// What the caller may lend to a match.
struct MatchHooks
{
    std::uint64_t (*now_ns)() = nullptr;                           ///< a monotonic clock
    void (*rows_done)(void* context, int rows, int all) = nullptr; ///< called from any worker after each row
    void* context = nullptr;
};

struct MatchOutcome
{
    DisparityMap map; ///< borrowed from the matcher's memory until the next match
    MatchTimes times;
};

namespace matching {
struct Bench;
}

/// A matcher for one picture size, with all the memory that it will ever use.
class Matcher
{
public:
    /// Checks the options against the picture size.
    /// Errors: kBadData for a size that cannot be matched, kUsage with the option's name and range.
    static Status check(int width, int height, const MatchOptions& options);

    /// Carves the matcher out of `arena`. With a measuring arena nothing may be matched; arena.peak() tells the need.
    /// Errors: those of check(); kConfig when the arena is too small.
    static Result<Matcher> make(int width, int height, const MatchOptions& options, const Kernels& kernels, int workers,
                                Arena& arena);

    /// Matches one pair of the matcher's size. Uses at most `workers` tasks of the crew. Cannot fail.
    MatchOutcome match(ImageView<const Rgb8> left, ImageView<const Rgb8> right, Crew& crew,
                       const MatchHooks& hooks = {});

    const MatchOptions& options() const { return options_; }
    /// Products of eq. 13 that one match computes: window pixels x pixels x disparities. kFast: those of a row and of
    /// every second row of a column; kBest: without its narrow window.
    std::uint64_t terms() const;

private:
    Matcher() = default;
    MatchOptions options_;
    matching::Bench* bench_ = nullptr;
};

} // namespace dicot
