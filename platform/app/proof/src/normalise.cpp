#include "kernel_proof.h"

#include <algorithm>
#include <limits>

namespace dicot::proof {
namespace {

constexpr std::uint32_t kLargestDenominator = 0x7FFFFFFF;

struct Call
{
    int n;
    std::span<std::uint32_t> numerator, denominator;
    Twin<std::uint16_t> out;

    Call(Stand& stand, int count)
        : n(count), numerator(stand.input<std::uint32_t>(static_cast<std::size_t>(n))),
          denominator(stand.input<std::uint32_t>(static_cast<std::size_t>(n))),
          out(stand.output<std::uint16_t>(static_cast<std::size_t>(n)))
    {
    }
    void run(const Kernels& kernels, std::span<std::uint16_t> to) const
    {
        kernels.normalise(to.data(), numerator.data(), denominator.data(), n);
    }
};

void work(const Kernels& tested, Stand& stand, Verdict& verdict)
{
    struct Vector
    {
        std::uint32_t numerator, denominator;
        std::uint16_t quotient;
    };
    constexpr Vector kVectors[] = {
        {0, 1, 0},
        {7, 2, 896},                      // 3.5 * 256
        {1, 3, 85},                       // 85.33
        {2, 3, 170},                      // 170.67 is not rounded up
        {600, 3, 51200},                  // the largest: 200 * 256
        {1, 257, 0},                      // 0.996
        {2, 257, 1},                      // 1.99
        {200, 1, 51200},
        {0, 2147483647, 0},
        {8388607, 2147483647, 0},         // 2^31 - 256 is less than 2^31 - 1
        {8388608, 2147483647, 1},         // 2^31 is more
        {4294967295, 2147483647, 512},    // (2^32 - 1) * 256 = 512 * (2^31 - 1) + 256
        {4294967294, 2147483647, 512},    // 2 * (2^31 - 1), exactly
        {4294967293, 2147483647, 511},    // and one less
        {4294967295, 21474837, 51199},    // 21474837 * 200 = 2^32 + 104: just below the largest
        {3355377064, 16777213, 51199},    // 16777213 * 51199 = 256 * 3355377063 + 59: the first that reaches it ...
        {3355377063, 16777213, 51198},    // ... and the last that does not
    };
    for (const Vector& vector : kVectors) {
        constexpr int kCount = 7; // more than a vector, and some left over
        stand.begin(Placement::kLast);
        Call call(stand, kCount);
        std::ranges::fill(call.numerator, vector.numerator);
        std::ranges::fill(call.denominator, vector.denominator);
        if (const char* words = stand.trespass([&](int) { call.run(tested, call.out.tested); }); words[0] != 0)
            note_fault(verdict, "worked vector %d: %s", verdict.worked, words);
        for (const std::uint16_t found : call.out.tested)
            if (found != vector.quotient)
                note_fault(verdict, "worked vector %d: floor(%u * 256 / %u) is %d, right is %d", verdict.worked,
                           vector.numerator, vector.denominator, found, vector.quotient);
        ++verdict.worked;
    }
}

enum class Quotients
{
    kAnywhere,
    kWhole,        ///< the smallest numerator that reaches a whole quotient
    kAlmostWhole,  ///< the largest that does not
    kLargest,      ///< the largest numerator of the domain
};

std::uint32_t largest_numerator(std::uint32_t denominator)
{
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(std::uint64_t{denominator} * kCostMax, std::numeric_limits<std::uint32_t>::max()));
}

void fill(Call& call, Dice& dice, Quotients quotients)
{
    for (std::size_t i = 0; i < call.numerator.size(); ++i) {
        // As many small denominators as large ones, and the powers of two and their neighbours.
        const int bits = dice.between(1, 31);
        const std::uint32_t power = 1u << (bits - 1);
        const std::uint32_t below = power + dice.up_to(power - 1);
        const std::uint32_t near = std::clamp(power + dice.up_to(2) - 1, 1u, kLargestDenominator);
        const std::uint32_t denominator = dice.up_to(3) == 0 ? near : below;
        const std::uint32_t most = largest_numerator(denominator);
        const std::uint32_t any = dice.up_to(most);
        std::uint32_t numerator = any;
        if (quotients == Quotients::kLargest) {
            numerator = most;
        } else if (quotients != Quotients::kAnywhere) {
            const std::uint64_t quotient = std::uint64_t{any} * 256 / denominator;
            numerator = static_cast<std::uint32_t>((quotient * denominator + 255) / 256);
            if (quotients == Quotients::kAlmostWhole && numerator > 0)
                --numerator;
        }
        call.numerator[i] = numerator;
        call.denominator[i] = denominator;
    }
}

void compare(const Kernels& tested, Stand& stand, Dice& dice, Verdict& verdict)
{
    const auto run_case = [&](int n, Quotients quotients, Placement placement) {
        stand.begin(placement);
        Call call(stand, n);
        fill(call, dice, quotients);
        const char* words = stand.difference([&](int) { call.run(kScalarKernels, call.out.law); },
                                             [&](int) { call.run(tested, call.out.tested); });
        if (words[0] != 0)
            note_fault(verdict, "%d quotients of kind %d, %s: %s", n, static_cast<int>(quotients), word_for(placement),
                       words);
        ++verdict.compared;
    };
    for (const Quotients quotients :
         {Quotients::kAnywhere, Quotients::kWhole, Quotients::kAlmostWhole, Quotients::kLargest})
        for (const Placement placement : kPlacements) {
            for (int n = 0; n <= 97; ++n)
                run_case(n, quotients, placement);
            run_case(20011, quotients, placement);
        }
}

double time(const Kernels& tested, Stand& stand)
{
    Dice dice{1};
    stand.begin(Placement::kFirst);
    Call call(stand, 4096);
    fill(call, dice, Quotients::kAnywhere);
    return best_rate(call.n, [&](int) { call.run(tested, call.out.tested); });
}

} // namespace

const KernelProof kNormaliseProof = {
    "normalise", "quotients", [](const Kernels& a, const Kernels& b) { return a.normalise == b.normalise; }, work,
    compare, time};

} // namespace dicot::proof
