#include "dicot/os/cpu.h"
#include "dicot/proof/proof.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

namespace dicot::proof {
namespace {

std::set<std::string> levels_here()
{
    std::set<std::string> levels = {"scalar"};
    if (cpu_features().avx2)
        levels.insert("avx2");
    if (cpu_features().neon)
        levels.insert("neon");
    return levels;
}

TEST(KernelProof, EveryKernelOfEveryLevelOfThisProcessorGivesTheLawsBytes)
{
    const std::uint64_t seed = std::random_device{}();
    SCOPED_TRACE("dicot selftest --seed " + std::to_string(seed));
    const Result<Report> outcome = prove_this_processor(seed);
    ASSERT_TRUE(outcome.ok()) << outcome.status().message();
    const Report& report = outcome.value();

    std::set<std::string> reached;
    for (const Verdict& verdict : report.verdicts()) {
        EXPECT_TRUE(verdict.proven()) << verdict.level << ' ' << verdict.kernel << ": " << verdict.fault;
        EXPECT_GT(verdict.per_second, 0) << verdict.level << ' ' << verdict.kernel;
        reached.insert(verdict.level);
        std::printf("%-7s %-16s %3d vectors, %5d cases, %.3g %s/s, %.1f x scalar\n", verdict.level, verdict.kernel,
                    verdict.worked, verdict.compared, verdict.per_second, verdict.unit, verdict.ratio);
    }
    EXPECT_EQ(reached, levels_here());
    EXPECT_EQ(report.verdicts().size(), 8 * reached.size());
    EXPECT_TRUE(report.passed());
}

} // namespace
} // namespace dicot::proof
