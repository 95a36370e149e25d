#include "kernel_proof.h"

#include <algorithm>

namespace dicot::proof {
namespace {

struct Shape
{
    int columns, pixels, disparities;
    int left_gap, right_gap; // words between the end of a row and the next one
};

struct Call
{
    Shape shape;
    int left_stride, right_stride;
    std::span<PairU16> left, right, costs;
    Twin<std::uint32_t> numerator, denominator;

    Call(Stand& stand, Shape wanted)
        : shape(wanted), left_stride(shape.pixels + shape.left_gap),
          right_stride(shape.pixels + shape.disparities - 1 + shape.right_gap)
    {
        const bool any = shape.pixels > 0;
        const auto words = [&](int count) { return any ? static_cast<std::size_t>(count) : std::size_t{0}; };
        // The last row ends with its last weight: no gap follows.
        left = stand.input<PairU16>(words((shape.columns - 1) * left_stride + shape.pixels));
        right = stand.input<PairU16>(
            words((shape.columns - 1) * right_stride + shape.pixels + shape.disparities - 1));
        costs = stand.input<PairU16>(words((shape.pixels + shape.columns - 1) * shape.disparities));
        numerator = stand.output<std::uint32_t>(words(shape.pixels * shape.disparities));
        denominator = stand.output<std::uint32_t>(words(shape.pixels * shape.disparities));
    }
    void run(const Kernels& kernels, std::span<std::uint32_t> to_numerator,
             std::span<std::uint32_t> to_denominator) const
    {
        kernels.aggregate({left.data(), right.data(), costs.data(), to_numerator.data(), to_denominator.data(),
                           left_stride, right_stride, shape.columns, shape.pixels, shape.disparities});
    }
};

void work(const Kernels& tested, Stand& stand, Verdict& verdict)
{
    // Two pixels, eight positions, three columns; weights and costs are the same at all of them, but for the costs of
    // the rows 0 .. 3, which tell the pixels apart. Column by column, with round(x) = floor(x + 1/2):
    //   0: even row: 32767 * 16383 / 2^15 = 16382.5 -> 16383     odd row: 16384 * 1 / 2^15 = 0.5 -> 1
    //   1: even row: 16384 * 5 / 2^15 = 2.5 -> 3                 odd row: 0 * 16383 -> 0
    //   2: even row: 10000 * 10000 / 2^15 = 3051.8 -> 3052       odd row: 16383 * 1 / 2^15 = 0.49997 -> 0
    // Denominators: 16383 + 1 + 3 + 0 + 3052 + 0 = 19439 for both.
    // Numerators: pixel 0 meets the cost rows 0, 1, 2: 16383 * 200 + 1 * 7 + 3 * 10 + 3052 * 100 = 3581837;
    //             pixel 1 meets the cost rows 1, 2, 3: 16383 * 10 + 1 * 200 + 3 * 100 + 3052 * 1 = 167382.
    constexpr PairU16 kLeft[] = {{32767, 16384}, {16384, 0}, {10000, 16383}};
    constexpr PairU16 kRight[] = {{16383, 1}, {5, 16383}, {10000, 1}};
    constexpr PairU16 kCosts[] = {{200, 7}, {10, 200}, {100, 200}, {1, 200}};
    constexpr std::uint32_t kNumerator[] = {3581837, 167382};
    constexpr std::uint32_t kDenominator = 19439;
    constexpr std::uint32_t kBefore = 1000000;
    for (const int disparities : {8, 24, 40}) {
        stand.begin(Placement::kLast);
        Call call(stand, {3, 2, disparities, 3, 5});
        for (std::size_t c = 0; c < 3; ++c) {
            const auto row = [c](std::span<PairU16> words, int stride) {
                const std::size_t start = c * static_cast<std::size_t>(stride);
                return words.subspan(start, std::min(static_cast<std::size_t>(stride), words.size() - start));
            };
            std::ranges::fill(row(call.left, call.left_stride), kLeft[c]);
            std::ranges::fill(row(call.right, call.right_stride), kRight[c]);
        }
        for (std::size_t k = 0; k < call.costs.size(); ++k)
            call.costs[k] = kCosts[k / static_cast<std::size_t>(disparities)];
        std::ranges::fill(call.numerator.tested, kBefore);
        std::ranges::fill(call.denominator.tested, kBefore);
        const char* words =
            stand.trespass([&](int) { call.run(tested, call.numerator.tested, call.denominator.tested); });
        if (words[0] != 0)
            note_fault(verdict, "worked vector of %d disparities: %s", disparities, words);
        for (std::size_t k = 0; k < call.numerator.tested.size(); ++k) {
            const std::uint32_t numerator = kBefore + kNumerator[k / static_cast<std::size_t>(disparities)];
            if (call.numerator.tested[k] != numerator || call.denominator.tested[k] != kBefore + kDenominator)
                note_fault(verdict, "worked vector of %d disparities: %u / %u at %zu, right is %u / %u", disparities,
                           call.numerator.tested[k], call.denominator.tested[k], k, numerator, kBefore + kDenominator);
        }
        ++verdict.worked;
    }
}

void fill(Call& call, Dice& dice, Filling weights, Filling costs)
{
    const auto u16 = [](std::uint32_t value) { return static_cast<std::uint16_t>(value); };
    for (PairU16& pair : call.left)
        pair = {u16(draw(dice, weights, kLeftWeightOne)), u16(draw(dice, weights, kLeftWeightOne))};
    for (PairU16& pair : call.right)
        pair = {u16(draw(dice, weights, kRightWeightOne)), u16(draw(dice, weights, kRightWeightOne))};
    for (PairU16& pair : call.costs)
        pair = {u16(draw(dice, costs, kCostMax)), u16(draw(dice, costs, kCostMax))};
    // What the other groups of the widest window may have added before.
    constexpr std::uint32_t kMostWeight = std::uint32_t{kMaxWindow - 1} * kMaxWindow * kRightWeightOne;
    for (std::size_t k = 0; k < call.numerator.law.size(); ++k) {
        call.numerator.tested[k] = call.numerator.law[k] = draw(dice, weights, kMostWeight * kCostMax);
        call.denominator.tested[k] = call.denominator.law[k] = draw(dice, weights, kMostWeight);
    }
}

void compare(const Kernels& tested, Stand& stand, Dice& dice, Verdict& verdict)
{
    const auto run_case = [&](Shape shape, Filling weights, Filling costs, Placement placement) {
        shape.left_gap = dice.between(0, 9);
        shape.right_gap = dice.between(0, 9);
        stand.begin(placement);
        Call call(stand, shape);
        fill(call, dice, weights, costs);
        const char* words =
            stand.difference([&](int) { call.run(kScalarKernels, call.numerator.law, call.denominator.law); },
                             [&](int) { call.run(tested, call.numerator.tested, call.denominator.tested); });
        if (words[0] != 0)
            note_fault(verdict, "%d columns, %d pixels, %d disparities, strides %d and %d, weights %s, costs %s, %s: %s",
                       shape.columns, shape.pixels, shape.disparities, call.left_stride, call.right_stride,
                       word_for(weights), word_for(costs), word_for(placement), words);
        ++verdict.compared;
    };
    constexpr Filling kRandom = Filling::kRandom;
    for (const Placement placement : kPlacements) {
        for (int pixels = 0; pixels <= 97; ++pixels)
            run_case({1 + pixels % 5, pixels, 8 * (1 + pixels % 3)}, kRandom, kRandom, placement);
        for (int columns = 1; columns <= kMaxWindow; ++columns)
            for (const int disparities : {8, 16, 56})
                run_case({columns, dice.between(1, 4), disparities}, kRandom, kRandom, placement);
        for (int disparities = 8; disparities <= 256; disparities += 8)
            for (const int columns : {1, 2, kMaxWindow})
                run_case({columns, dice.between(1, 4), disparities}, kRandom, kRandom, placement);
        for (const Filling weights : kFillings)
            for (const Filling costs : kFillings)
                for (const int columns : {kMaxWindow - 1, kMaxWindow})
                    run_case({columns, 3, 72}, weights, costs, placement);
        run_case({kMaxWindow, 131, 64}, kRandom, kRandom, placement);
    }
}

double time(const Kernels& tested, Stand& stand)
{
    Dice dice{1};
    stand.begin(Placement::kFirst);
    Call call(stand, {kMaxWindow, 64, 64, 0, 0});
    fill(call, dice, Filling::kRandom, Filling::kRandom);
    const double terms = 2.0 * call.shape.columns * call.shape.pixels * call.shape.disparities;
    return best_rate(terms, [&](int) { call.run(tested, call.numerator.tested, call.denominator.tested); });
}

} // namespace

const KernelProof kAggregateProof = {
    "aggregate", "terms", [](const Kernels& a, const Kernels& b) { return a.aggregate == b.aggregate; }, work, compare,
    time};

} // namespace dicot::proof
