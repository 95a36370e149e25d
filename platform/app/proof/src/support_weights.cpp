#include "kernel_proof.h"

#include <algorithm>

namespace dicot::proof {
namespace {

struct Row
{
    std::span<PairS16> la, b;
    LabRow view() const { return {la.data(), b.data()}; }
};

Row take_row(Stand& stand, int n)
{
    const auto size = static_cast<std::size_t>(n);
    return {stand.input<PairS16>(size), stand.input<PairS16>(size)};
}

struct Call
{
    int n;
    Row p, q_low, q_high;
    std::span<std::uint16_t> colour;
    PairU16 spatial;
    Twin<PairU16> out;

    Call(Stand& stand, int pixels)
        : n(pixels), p(take_row(stand, n)), q_low(take_row(stand, n)), q_high(take_row(stand, n)),
          colour(stand.input<std::uint16_t>(kColourTableAllocation)), spatial(),
          out(stand.output<PairU16>(static_cast<std::size_t>(n)))
    {
    }
    void run(const Kernels& kernels, std::span<PairU16> to) const
    {
        kernels.support_weights(to.data(), n, p.view(), q_low.view(), q_high.view(), colour.data(), spatial);
    }
};

void work(const Kernels& tested, Stand& stand, Verdict& verdict)
{
    // Position of a distance D = 2^e (1 + f): 64 e + floor(64 f) + 1, and 0 for D = 0. The table gives 32767 - 16 * position.
    struct Vector
    {
        PairS16 p_la, q_la;
        std::int16_t p_b, q_b;
        std::uint16_t spatial, weight;
    };
    constexpr Vector kVectors[] = {
        // Same colour: 32767; 32767 * 32767 / 2^15 = 32766.00003.
        {{160, 5}, {160, 5}, -7, -7, 32767, 32766},
        // D = 1: position 1; 32751 * 16384 / 2^15 = 16375.5, a half rounds up.
        {{160, 5}, {160, 6}, -7, -7, 16384, 16376},
        // D = 3^2 + 4^2 = 25 = 2^4 * 1.5625: position 256 + 36 + 1; 32767 - 4688 = 28079; 28079 / 2 = 14039.5.
        {{160, 3}, {163, -1}, 0, 0, 16384, 14040},
        // D = 1 + 4 + 4 = 9 = 2^3 * 1.125: position 192 + 8 + 1; 29551 * 3 / 2^15 = 2.7.
        {{0, 0}, {1, -2}, 2, 0, 3, 3},
        // D = 8190^2 + 1 + 181^2 = 2^26 - 2 has 26 digits: as a single it is 2^26. Position 1665 (cut off: 1664); 6127.
        // 6127 * 32767 / 2^15 = 6126.8; the cut one would give 6143.
        {{8190, 0}, {0, 1}, 181, 0, 32767, 6127},
        // A pixel outside: D = 28400^2 = 2^29 * 1.50233: position 1856 + 32 + 1; 32767 - 30224 = 2543;
        // 2543 * 32767 / 2^15 = 2542.9.
        {{1600, 0}, {kLabOutside, 0}, 0, 0, 32767, 2543},
        // No spatial weight, no weight.
        {{160, 5}, {160, 5}, -7, -7, 0, 0},
        // 32767 * 1 / 2^15 = 0.99997.
        {{160, 5}, {160, 5}, -7, -7, 1, 1},
    };
    constexpr int kPixels = 11; // more than a vector, and some left over
    const PairS16 outside = {kLabOutside, 0};
    for (const Vector& vector : kVectors) {
        for (const bool in_high : {false, true}) {
            stand.begin(Placement::kLast);
            Call call(stand, kPixels);
            for (int i = 0; i < kColourTableAllocation; ++i)
                call.colour[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(std::max(32767 - 16 * i, 0));
            const Row& matched = in_high ? call.q_high : call.q_low;
            const Row& other = in_high ? call.q_low : call.q_high;
            std::ranges::fill(call.p.la, vector.p_la);
            std::ranges::fill(call.p.b, PairS16{vector.p_b, 0});
            std::ranges::fill(matched.la, vector.q_la);
            std::ranges::fill(matched.b, PairS16{vector.q_b, 0});
            std::ranges::fill(other.la, outside);
            std::ranges::fill(other.b, PairS16{0, 0});
            (in_high ? call.spatial.high : call.spatial.low) = vector.spatial;
            if (const char* words = stand.trespass([&](int) { call.run(tested, call.out.tested); }); words[0] != 0)
                note_fault(verdict, "worked vector %d: %s", verdict.worked, words);
            for (const PairU16& found : call.out.tested) {
                const std::uint16_t weight = in_high ? found.high : found.low;
                const std::uint16_t beside = in_high ? found.low : found.high;
                if (weight != vector.weight || beside != 0)
                    note_fault(verdict, "worked vector %d: weight %d beside %d, right is %d beside 0", verdict.worked,
                               weight, beside, vector.weight);
            }
            ++verdict.worked;
        }
    }
}

enum class Colours
{
    kAnywhere,  ///< all of CIELAB in the picture
    kNear,      ///< small differences: the table's first octaves
    kOutside,   ///< window pixels outside the picture
    kFarthest,  ///< the largest differences of the domain
};

PairS16 draw_la(Dice& dice, Colours colours, bool centre)
{
    const auto s16 = [](int value) { return static_cast<std::int16_t>(value); };
    switch (colours) {
    case Colours::kAnywhere:
        return {s16(dice.between(0, 100 * kLabScale)), s16(dice.between(-3000, 3000))};
    case Colours::kNear:
        return {s16(dice.between(800, 806)), s16(dice.between(-3, 3))};
    case Colours::kOutside:
        return centre ? PairS16{s16(dice.between(0, 100 * kLabScale)), s16(dice.between(-3000, 3000))}
                      : PairS16{kLabOutside, 0};
    case Colours::kFarthest:
        return centre ? PairS16{0, -3000} : PairS16{kLabOutside, 3000};
    }
    return {};
}

void fill(Call& call, Dice& dice, Colours colours, Filling weights)
{
    for (const auto* row : {&call.p, &call.q_low, &call.q_high}) {
        const bool centre = row == &call.p;
        for (PairS16& la : row->la)
            la = draw_la(dice, colours, centre);
        for (PairS16& b : row->b)
            b = {colours == Colours::kFarthest ? static_cast<std::int16_t>(centre ? 3000 : -3000)
                                               : draw_la(dice, colours, true).high,
                 0};
    }
    for (std::uint16_t& entry : call.colour)
        entry = static_cast<std::uint16_t>(draw(dice, weights, kLeftWeightOne));
    call.spatial = {static_cast<std::uint16_t>(draw(dice, weights, kLeftWeightOne)),
                    static_cast<std::uint16_t>(draw(dice, weights, kLeftWeightOne))};
}

void compare(const Kernels& tested, Stand& stand, Dice& dice, Verdict& verdict)
{
    const auto run_case = [&](int n, Colours colours, Filling weights, Placement placement) {
        stand.begin(placement);
        Call call(stand, n);
        fill(call, dice, colours, weights);
        const char* words = stand.difference([&](int) { call.run(kScalarKernels, call.out.law); },
                                             [&](int) { call.run(tested, call.out.tested); });
        if (words[0] != 0)
            note_fault(verdict, "%d pixels, colours %d, weights %s, %s: %s", n, static_cast<int>(colours),
                       word_for(weights), word_for(placement), words);
        ++verdict.compared;
    };
    for (const Colours colours : {Colours::kAnywhere, Colours::kNear, Colours::kOutside, Colours::kFarthest})
        for (const Placement placement : kPlacements) {
            for (int n = 0; n <= 97; ++n)
                run_case(n, colours, Filling::kRandom, placement);
            for (const int n : {640, 1283, 4099})
                for (const Filling weights : kFillings)
                    run_case(n, colours, weights, placement);
        }
}

double time(const Kernels& tested, Stand& stand)
{
    Dice dice{1};
    stand.begin(Placement::kFirst);
    Call call(stand, 1280);
    fill(call, dice, Colours::kAnywhere, Filling::kRandom);
    return best_rate(2.0 * call.n, [&](int) { call.run(tested, call.out.tested); });
}

} // namespace

const KernelProof kSupportWeightsProof = {
    "support_weights", "weights",
    [](const Kernels& a, const Kernels& b) { return a.support_weights == b.support_weights; }, work, compare, time};

} // namespace dicot::proof
