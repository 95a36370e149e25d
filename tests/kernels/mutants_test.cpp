// The proof can fail: each kernel here is the law with one small fault, and must be found out.
#include "dicot/proof/proof.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

namespace dicot::proof {
namespace {

// The verdict of a table that is the law but for one kernel.
Verdict verdict_of(const Kernels& mutant)
{
    Report report{20};
    const Status status = prove_level(mutant, report);
    EXPECT_TRUE(status.ok()) << status.message();
    EXPECT_FALSE(report.passed());
    EXPECT_EQ(report.verdicts().size(), 1u);
    return report.verdicts().empty() ? Verdict{} : report.verdicts()[0];
}

Kernels law_called(const char* name)
{
    Kernels kernels = kScalarKernels;
    kernels.name = name;
    return kernels;
}

void expect_found_out(const Kernels& mutant, const char* kernel)
{
    const Verdict verdict = verdict_of(mutant);
    EXPECT_STREQ(verdict.kernel, kernel);
    EXPECT_FALSE(verdict.proven());
    EXPECT_STRNE(verdict.fault, "");
    EXPECT_EQ(verdict.per_second, 0) << "speed is told only of what is equal";
}

TEST(KernelMutants, AProductCutOffInsteadOfRoundedIsFoundOut)
{
    Kernels mutant = law_called("cuts off");
    mutant.aggregate = [](const AggregateStrip& s) {
        for (int i = 0; i < s.pixels; ++i)
            for (int r = 0; r < s.disparities; ++r)
                for (int c = 0; c < s.columns; ++c) {
                    const PairU16 left = s.left_weights[c * s.left_stride + i];
                    const PairU16 right = s.right_weights[c * s.right_stride + i + r];
                    const PairU16 cost = s.costs[(i + c) * s.disparities + r];
                    const std::uint32_t low = (std::uint32_t{left.low} * right.low) >> 15;
                    const std::uint32_t high = (std::uint32_t{left.high} * right.high) >> 15;
                    s.numerator[i * s.disparities + r] += low * cost.low + high * cost.high;
                    s.denominator[i * s.disparities + r] += low + high;
                }
    };
    expect_found_out(mutant, "aggregate");
}

TEST(KernelMutants, AForgottenLastColumnIsFoundOut)
{
    Kernels mutant = law_called("forgets");
    mutant.aggregate = [](const AggregateStrip& s) {
        AggregateStrip shorter = s;
        shorter.columns = s.columns > 34 ? 34 : s.columns;
        kScalarKernels.aggregate(shorter);
    };
    expect_found_out(mutant, "aggregate");
}

TEST(KernelMutants, AQuotientRoundedInsteadOfCutOffIsFoundOut)
{
    Kernels mutant = law_called("rounds");
    mutant.normalise = [](std::uint16_t* out, const std::uint32_t* numerator, const std::uint32_t* denominator, int n) {
        for (int i = 0; i < n; ++i)
            out[i] =
                static_cast<std::uint16_t>((std::uint64_t{numerator[i]} * 256 + denominator[i] / 2) / denominator[i]);
    };
    expect_found_out(mutant, "normalise");
}

TEST(KernelMutants, AQuotientInSinglePrecisionIsFoundOut)
{
    Kernels mutant = law_called("single precision");
    mutant.normalise = [](std::uint16_t* out, const std::uint32_t* numerator, const std::uint32_t* denominator, int n) {
        for (int i = 0; i < n; ++i)
            out[i] = static_cast<std::uint16_t>(
                std::min(static_cast<float>(numerator[i]) * 256 / static_cast<float>(denominator[i]), 51200.0F));
    };
    expect_found_out(mutant, "normalise");
}

TEST(KernelMutants, ADistanceCutOffInsteadOfRoundedToASingleIsFoundOut)
{
    Kernels mutant = law_called("cuts the distance off");
    mutant.support_weights = [](PairU16* out, int n, LabRow p, LabRow q_low, LabRow q_high, const std::uint16_t* colour,
                                PairU16 spatial) {
        const auto weight = [&](LabRow q, int i, std::uint32_t space) {
            const int l = p.la[i].low - q.la[i].low, a = p.la[i].high - q.la[i].high, b = p.b[i].low - q.b[i].low;
            const auto whole = static_cast<unsigned>(l * l + a * a + b * b);
            const int surplus = std::max(static_cast<int>(std::bit_width(whole)) - 24, 0);
            const unsigned distance = whole >> surplus << surplus;
            const auto single = static_cast<float>(distance);
            std::uint32_t bits;
            std::memcpy(&bits, &single, sizeof bits);
            const int index = std::max(static_cast<int>(bits >> 17) - (127 * kColourSteps - 1), 0);
            return static_cast<std::uint16_t>((colour[index] * space + (1u << 14)) >> 15);
        };
        for (int i = 0; i < n; ++i)
            out[i] = {weight(q_low, i, spatial.low), weight(q_high, i, spatial.high)};
    };
    expect_found_out(mutant, "support_weights");
}

TEST(KernelMutants, ATailThatIsNotComputedIsFoundOut)
{
    Kernels mutant = law_called("leaves the tail");
    mutant.support_weights = [](PairU16* out, int n, LabRow p, LabRow q_low, LabRow q_high, const std::uint16_t* colour,
                                PairU16 spatial) {
        kScalarKernels.support_weights(out, n / 8 * 8, p, q_low, q_high, colour, spatial);
    };
    expect_found_out(mutant, "support_weights");
}

TEST(KernelMutants, WritingOneElementTooManyIsFoundOut)
{
    Kernels mutant = law_called("writes on");
    mutant.support_weights = [](PairU16* out, int n, LabRow p, LabRow q_low, LabRow q_high, const std::uint16_t* colour,
                                PairU16 spatial) {
        kScalarKernels.support_weights(out, n, p, q_low, q_high, colour, spatial);
        out[n] = {0, 0};
    };
    expect_found_out(mutant, "support_weights");
}

TEST(KernelMutants, OverwritingTheOtherRowsCostsIsFoundOut)
{
    Kernels mutant = law_called("overwrites");
    mutant.match_cost = [](std::uint16_t* out, int n, int disparities, CostRow left, CostRow right,
                           const CostTables& tables) {
        kScalarKernels.match_cost(out, n, disparities, left, right, tables);
        if (n > 0)
            out[1] = 0;
    };
    expect_found_out(mutant, "match_cost");
}

// What a harmless-looking vector load does at the end of a row: the value read is not used.
[[gnu::noinline]] void read(const volatile std::uint8_t* byte)
{
    (void)*byte;
}

TEST(KernelMutants, ReadingOneByteBehindARowIsFoundOut)
{
    Kernels mutant = law_called("reads on");
    mutant.match_cost = [](std::uint16_t* out, int n, int disparities, CostRow left, CostRow right,
                           const CostTables& tables) {
        kScalarKernels.match_cost(out, n, disparities, left, right, tables);
        if (n > 0)
            read(right.blue + n + disparities - 1);
    };
    const Verdict verdict = verdict_of(mutant);
    EXPECT_NE(std::string(verdict.fault).find("outside"), std::string::npos) << verdict.fault;
}

TEST(KernelMutants, ReadingOneByteBeforeARowIsFoundOut)
{
    Kernels mutant = law_called("reads before");
    mutant.match_cost = [](std::uint16_t* out, int n, int disparities, CostRow left, CostRow right,
                           const CostTables& tables) {
        kScalarKernels.match_cost(out, n, disparities, left, right, tables);
        if (n > 0)
            read(left.census - 1);
    };
    const Verdict verdict = verdict_of(mutant);
    EXPECT_NE(std::string(verdict.fault).find("outside"), std::string::npos) << verdict.fault;
}

TEST(KernelMutants, APathThatLosesTheNeighbourAcrossTwoVectorsIsFoundOut)
{
    Kernels mutant = law_called("loses a neighbour");
    mutant.path_step = [](std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                          std::uint16_t least, PathPenalty penalty, int first, int axis) {
        std::uint16_t lost[256];
        std::copy_n(behind, axis, lost);
        kScalarKernels.path_step(ahead, costs, behind, least, penalty, first, axis);
        if (axis > 16) {
            lost[15] = kNoCandidate;
            std::uint16_t without[256];
            kScalarKernels.path_step(without, costs, lost, least, penalty, first, axis);
            ahead[16] = without[16];
        }
        return *std::min_element(ahead, ahead + axis);
    };
    expect_found_out(mutant, "path_step");
}

TEST(KernelMutants, ASumThatWrapsInsteadOfSaturatingIsFoundOut)
{
    Kernels mutant = law_called("wraps");
    mutant.path_step = [](std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                          std::uint16_t least, PathPenalty penalty, int first, int axis) {
        std::uint16_t worst = 0;
        for (int r = first; r < axis; ++r)
            worst = std::max(worst, costs[r] == kNoCandidate ? std::uint16_t{0} : costs[r]);
        std::fill_n(ahead, first, kNoCandidate);
        for (int r = first; r < axis; ++r) {
            const std::uint16_t before = r > first ? behind[r - 1] : kNoCandidate;
            const std::uint16_t after = r + 1 < axis ? behind[r + 1] : kNoCandidate;
            const auto near = static_cast<std::uint16_t>(std::min(before, after) + penalty.small);
            const auto jump = static_cast<std::uint16_t>(least + penalty.large);
            ahead[r] = static_cast<std::uint16_t>(std::min(costs[r], worst) +
                                                  std::min(std::min(behind[r], near), jump) - least);
        }
        return *std::min_element(ahead, ahead + axis);
    };
    expect_found_out(mutant, "path_step");
}

TEST(KernelMutants, APositionWithoutCandidateThatCostsTheMostThereIsIsFoundOut)
{
    Kernels mutant = law_called("knows the worst");
    mutant.path_step = [](std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                          std::uint16_t least, PathPenalty penalty, int first, int axis) {
        std::uint16_t seen[256];
        std::replace_copy(costs, costs + axis, seen, kNoCandidate, std::uint16_t{kWorstCost});
        return kScalarKernels.path_step(ahead, seen, behind, least, penalty, first, axis);
    };
    expect_found_out(mutant, "path_step");
}

TEST(KernelMutants, TheFirstOfTwoEqualWinnersIsFoundOut)
{
    Kernels mutant = law_called("takes the first");
    mutant.winners = [](Winner* out, const std::uint16_t* costs, int n, int axis) {
        kScalarKernels.winners(out, costs, n, axis);
        for (int i = 0; i < n; ++i) {
            const std::uint16_t* const from = costs + i * axis;
            out[i].position = static_cast<std::uint16_t>(std::min_element(from, from + axis) - from);
        }
    };
    expect_found_out(mutant, "winners");
}

TEST(KernelMutants, ARivalBesideTheWinnerIsFoundOut)
{
    Kernels mutant = law_called("takes a neighbour for a rival");
    mutant.winners = [](Winner* out, const std::uint16_t* costs, int n, int axis) {
        kScalarKernels.winners(out, costs, n, axis);
        for (int i = 0; i < n; ++i)
            if (out[i].position > 0)
                out[i].runner_up = std::min(out[i].runner_up, costs[i * axis + out[i].position - 1]);
    };
    expect_found_out(mutant, "winners");
}

TEST(KernelMutants, ALaterPixelThatWinsATieOnTheRightIsFoundOut)
{
    Kernels mutant = law_called("lets the later one win");
    mutant.right_winners = [](std::uint16_t* cost, std::uint16_t* position, const std::uint16_t* costs, int n,
                              int axis) {
        kScalarKernels.right_winners(cost, position, costs, n, axis);
        for (int i = 0; i < n; ++i)
            for (int r = 0; r < axis; ++r)
                if (costs[i * axis + r] == cost[i + r] && cost[i + r] != kNoCandidate)
                    position[i + r] = static_cast<std::uint16_t>(r);
    };
    expect_found_out(mutant, "right_winners");
}

TEST(KernelMutants, ForgottenEntriesBehindTheLastPixelAreFoundOut)
{
    Kernels mutant = law_called("stops at the row's end");
    mutant.right_winners = [](std::uint16_t* cost, std::uint16_t* position, const std::uint16_t* costs, int n,
                              int axis) {
        kScalarKernels.right_winners(cost, position, costs, n, axis);
        for (int j = n; j < n + axis - 1 && n > 0; ++j)
            cost[j] = kNoCandidate;
    };
    expect_found_out(mutant, "right_winners");
}

/// The law of remap_row with positions moved by `shift` before they are rounded, within the contract's domain.
void remap_moved(std::uint8_t* rgb, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source, int shift)
{
    for (int i = 0; i < n; ++i) {
        const RemapSpan& span = spans[i >> cell_log2];
        const int u = i & ((1 << cell_log2) - 1);
        constexpr std::int64_t kMost = (std::int64_t{1} << 31) - 1 - (1 << 8);
        const std::int64_t x = std::int64_t{span.x} + u * span.dx + shift;
        const RemapSpan moved{static_cast<std::int32_t>(std::clamp(x, -kMost, kMost)), span.y + u * span.dy, 0, 0};
        kScalarKernels.remap_row(rgb + 3 * i, 1, &moved, cell_log2, source);
    }
}

TEST(KernelMutants, APositionCutOffInsteadOfRoundedIsFoundOut)
{
    Kernels mutant = law_called("cuts the position off");
    mutant.remap_row = [](std::uint8_t* rgb, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source) {
        remap_moved(rgb, n, spans, cell_log2, source, -(1 << 8));
    };
    expect_found_out(mutant, "remap_row");
}

TEST(KernelMutants, APositionOffByOneOf65536OfAPixelIsFoundOut)
{
    Kernels mutant = law_called("off by one");
    mutant.remap_row = [](std::uint8_t* rgb, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source) {
        remap_moved(rgb, n, spans, cell_log2, source, 1);
    };
    expect_found_out(mutant, "remap_row");
}

TEST(KernelMutants, ALastColumnTakenForOutsideIsFoundOut)
{
    Kernels mutant = law_called("loses a column");
    mutant.remap_row = [](std::uint8_t* rgb, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source) {
        kScalarKernels.remap_row(rgb, n, spans, cell_log2, source);
        for (int i = 0; i < n; ++i) {
            const RemapSpan& span = spans[i >> cell_log2];
            const int x = span.x + (i & ((1 << cell_log2) - 1)) * span.dx;
            if ((x + (1 << 8)) >> 9 == 128 * (source.width - 1))
                std::fill_n(rgb + 3 * i, 3, std::uint8_t{0});
        }
    };
    expect_found_out(mutant, "remap_row");
}

TEST(KernelMutants, PixelsWithoutSourceThatAreNotClearedAreFoundOut)
{
    Kernels mutant = law_called("leaves gaps as they were");
    mutant.remap_row = [](std::uint8_t* rgb, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source) {
        for (int i = 0; i < n; ++i) {
            std::uint8_t pixel[3];
            const RemapSpan& span = spans[i >> cell_log2];
            const int u = i & ((1 << cell_log2) - 1);
            const RemapSpan at{span.x + u * span.dx, span.y + u * span.dy, 0, 0};
            kScalarKernels.remap_row(pixel, 1, &at, cell_log2, source);
            if (((at.x + (1 << 8)) >> 9) >= 0)
                std::copy_n(pixel, 3, rgb + 3 * i);
        }
    };
    expect_found_out(mutant, "remap_row");
}

TEST(KernelMutants, ReadingOneByteBehindAPictureIsFoundOut)
{
    Kernels mutant = law_called("reads behind the picture");
    mutant.remap_row = [](std::uint8_t* rgb, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source) {
        kScalarKernels.remap_row(rgb, n, spans, cell_log2, source);
        if (n > 0)
            read(source.rgb + (source.height - 1) * source.stride_bytes + 3 * source.width);
    };
    const Verdict verdict = verdict_of(mutant);
    EXPECT_NE(std::string(verdict.fault).find("outside"), std::string::npos) << verdict.fault;
}

TEST(KernelMutants, ARareFaultIsFoundAgainFromItsSeed)
{
    Kernels mutant = law_called("rarely wrong");
    mutant.normalise = [](std::uint16_t* out, const std::uint32_t* numerator, const std::uint32_t* denominator, int n) {
        kScalarKernels.normalise(out, numerator, denominator, n);
        for (int i = 0; i < n; ++i)
            if (numerator[i] % 499 == 1 && denominator[i] > 1000)
                ++out[i];
    };
    const auto fault = [&](std::uint64_t seed) {
        Report report{seed};
        EXPECT_TRUE(prove_level(mutant, report).ok());
        return std::string(report.verdicts()[0].fault);
    };
    EXPECT_NE(fault(1), "");
    EXPECT_EQ(fault(1), fault(1));
    EXPECT_NE(fault(1), fault(2));
}

TEST(KernelMutants, ATableThatIsTheLawItselfProvesNothing)
{
    Report report{20};
    ASSERT_TRUE(prove_level(law_called("copy"), report).ok());
    EXPECT_TRUE(report.verdicts().empty());
    EXPECT_FALSE(report.passed()) << "zero cases is a failure";
}

TEST(KernelMutants, AVerdictWithoutCasesIsNotProven)
{
    Verdict verdict;
    verdict.worked = 3;
    EXPECT_FALSE(verdict.proven()) << "nothing was compared";
    verdict.compared = 1;
    EXPECT_TRUE(verdict.proven());
    verdict.worked = 0;
    EXPECT_FALSE(verdict.proven()) << "no vector was worked";
}

TEST(KernelMutants, AFaultyLawFailsItsOwnVectors)
{
    Kernels law = kScalarKernels;
    law.normalise = [](std::uint16_t* out, const std::uint32_t*, const std::uint32_t*, int n) {
        std::fill_n(out, n, 1);
    };
    Report report{20};
    ASSERT_TRUE(prove_law(law, report).ok());
    EXPECT_FALSE(report.passed());
}

} // namespace
} // namespace dicot::proof
