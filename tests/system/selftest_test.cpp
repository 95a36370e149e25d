#include "tool.h"

#include "dicot/os/cpu.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <set>
#include <string>

namespace dicot::test {
namespace {

const std::string kDicot = DICOT_PROGRAM;

TEST(Selftest, ProvesTheLevelsOfThisProcessorAndSaysSoInJson)
{
    const ToolRun outcome = run(kDicot + " selftest --seed 5 --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    const nlohmann::json report = nlohmann::json::parse(outcome.output);
    EXPECT_EQ(report["seed"], 5);
    EXPECT_EQ(report["passed"], true);
    std::multiset<std::string> levels;
    for (const nlohmann::json& kernel : report["kernels"]) {
        EXPECT_EQ(kernel["proven"], true) << kernel;
        EXPECT_GT(kernel["units_per_s"], 0) << kernel;
        levels.insert(kernel["level"].get<std::string>());
    }
    EXPECT_EQ(levels.count("scalar"), 8u);
    EXPECT_EQ(levels.count("avx2"), cpu_features().avx2 ? 8u : 0u);
    EXPECT_EQ(levels.count("neon"), cpu_features().neon ? 8u : 0u);
}

TEST(Selftest, ChoosesAndTellsASeedWhenNoneIsGiven)
{
    const ToolRun first = run(kDicot + " selftest");
    ASSERT_EQ(first.exit_code, 0) << first.output;
    const ToolRun second = run(kDicot + " selftest");
    const auto seed = [](const ToolRun& outcome) { return outcome.output.substr(0, outcome.output.find('\n')); };
    EXPECT_EQ(seed(first).rfind("seed ", 0), 0u) << first.output;
    EXPECT_NE(seed(first), seed(second));
}

TEST(Selftest, ASeedThatIsNoNumberIsAFaultOfUsage)
{
    EXPECT_EQ(run(kDicot + " selftest --seed leaf").exit_code, 64);
}

} // namespace
} // namespace dicot::test
