// The proof that every instruction set computes what the scalar law computes, and how much faster.
#pragma once

#include "dicot/base/status.h"
#include "dicot/kernels/kernels.h"

#include <array>
#include <cstdint>
#include <span>

namespace dicot::proof {

/// What became of one kernel of one level.
struct Verdict
{
    static constexpr int kFaultBytes = 300;

    const char* level = "";
    const char* kernel = "";
    int worked = 0;   ///< vectors worked by hand that were run
    int compared = 0; ///< cases compared with the law (the law itself has none)
    bool is_law = false;
    char fault[kFaultBytes] = {}; ///< the first wrong case in words; empty: none
    const char* unit = "";        ///< what per_second counts
    double per_second = 0;        ///< measured only when proven
    double ratio = 0;             ///< to the law's speed in the same run

    /// Right in every case, and there were cases.
    bool proven() const { return fault[0] == 0 && worked > 0 && (is_law || compared > 0); }
};

/// Every verdict of one run.
class Report
{
public:
    static constexpr int kMost = 24;

    explicit Report(std::uint64_t seed) : seed_(seed) {}

    std::uint64_t seed() const { return seed_; } ///< gives the same cases again
    std::span<const Verdict> verdicts() const { return {verdicts_.data(), count_}; }
    /// At least one verdict, and every one proven.
    bool passed() const;
    /// The next verdict to fill. There are never more than kMost: a program has the law and at most one level more.
    Verdict& add() { return verdicts_.at(count_++); }

private:
    std::uint64_t seed_;
    std::array<Verdict, kMost> verdicts_{};
    std::size_t count_ = 0;
};

/// Runs the hand-worked vectors on the law, then proves every level that this program has and this processor can run.
/// Fails only when the system refuses memory; what is wrong with a kernel stands in the report.
Result<Report> prove_this_processor(std::uint64_t seed);

/// Proves those kernels of `tested` whose pointers differ from the law's: vectors worked by hand, then comparison over
/// many sizes and inputs in memory between guard pages, then speed. A level that shares every pointer adds no verdict.
Status prove_level(const Kernels& tested, Report& report);

/// Runs the hand-worked vectors on `law` and measures its speed.
Status prove_law(const Kernels& law, Report& report);

} // namespace dicot::proof
