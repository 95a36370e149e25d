#include "kernel_proof.h"

#include <algorithm>

namespace dicot::proof {
namespace {

struct Call
{
    int axis;
    int first;
    std::uint16_t least;
    PathPenalty penalty;
    std::span<std::uint16_t> costs, behind;
    Twin<std::uint16_t> ahead;
    Twin<std::uint16_t> least_ahead; // one

    Call(Stand& stand, int positions, int before)
        : axis(positions), first(before), least(), penalty(),
          costs(stand.input<std::uint16_t>(static_cast<std::size_t>(positions))),
          behind(stand.input<std::uint16_t>(static_cast<std::size_t>(positions))),
          ahead(stand.output<std::uint16_t>(static_cast<std::size_t>(positions))),
          least_ahead(stand.output<std::uint16_t>(1))
    {
    }
    void run(const Kernels& kernels, std::span<std::uint16_t> to, std::span<std::uint16_t> least_to) const
    {
        least_to[0] = kernels.path_step(to.data(), costs.data(), behind.data(), least, penalty, first, axis);
    }
};

constexpr std::uint16_t kNone = kNoCandidate;

struct Vector
{
    PathPenalty penalty;
    std::uint16_t least;
    int first;
    std::array<std::uint16_t, 8> costs, behind, ahead;
    std::uint16_t least_ahead;
};

constexpr Vector kVectors[] = {
    // least + large = 130. r = 1: 100 + 10; r = 2: 105 + 10, not 150 + 10; from r = 5 on: 130.
    {{10, 30},
     100,
     0,
     {5, 5, 5, 5, 5, 5, 5, 1000},
     {100, 150, 200, 105, 300, 300, 300, 300},
     {5, 15, 20, 10, 20, 35, 35, 1030},
     5},
    // What has no candidate costs 400, the worst of the others; the 50000 lies before the first position.
    {{10, 30},
     7,
     2,
     {50000, kNone, kNone, 400, kNone, 20, 50, kNone},
     {kNone, kNone, 7, 7, 7, 7, 7, 7},
     {kNone, kNone, 400, 400, 400, 20, 50, 400},
     20},
    // No candidate at all costs nothing.
    {{10, 30},
     0,
     0,
     {kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone},
     {0, 50, 0, 50, 50, 5, 50, 50},
     {0, 10, 0, 10, 15, 5, 15, 30},
     0},
    // The largest of everything: 51200 + 14334 is the largest sum that is none, 65534 + 14334 must not wrap.
    {{kMaxPathStep, kMaxPathStep},
     kWorstCost,
     0,
     {51200, 51200, 51200, 51200, 51200, 51200, 51200, 51200},
     {51200, 65534, 65534, 65534, 65534, 65534, 65534, 65535},
     {51200, 65534, 65534, 65534, 65534, 65534, 65534, 65534},
     51200},
};

void work(const Kernels& tested, Stand& stand, Verdict& verdict)
{
    const auto judge = [&](const Call& call, auto&& right, int right_least) {
        const auto run = [&](int) { call.run(tested, call.ahead.tested, call.least_ahead.tested); };
        if (const char* words = stand.trespass(run); words[0] != 0)
            note_fault(verdict, "worked vector %d: %s", verdict.worked, words);
        for (int r = 0; r < call.axis; ++r)
            if (const int found = call.ahead.tested[static_cast<std::size_t>(r)]; found != right(r))
                note_fault(verdict, "worked vector %d: position %d is %d, right is %d", verdict.worked, r, found,
                           right(r));
        if (call.least_ahead.tested[0] != right_least)
            note_fault(verdict, "worked vector %d: the least is %d, right is %d", verdict.worked,
                       call.least_ahead.tested[0], right_least);
        ++verdict.worked;
    };
    for (const Vector& vector : kVectors) {
        stand.begin(Placement::kLast);
        Call call(stand, 8, vector.first);
        call.least = vector.least;
        call.penalty = vector.penalty;
        std::ranges::copy(vector.costs, call.costs.begin());
        std::ranges::copy(vector.behind, call.behind.begin());
        judge(
            call, [&](int r) { return vector.ahead[static_cast<std::size_t>(r)]; }, vector.least_ahead);
    }
    // One valley, wherever it lies between vectors: its neighbours pay a small step, all others a large one.
    for (int valley = 0; valley < 40; ++valley) {
        stand.begin(Placement::kLast);
        Call call(stand, 40, 0);
        call.least = 100;
        call.penalty = {10, 30};
        std::ranges::fill(call.costs, std::uint16_t{1});
        std::ranges::fill(call.behind, std::uint16_t{300});
        call.behind[static_cast<std::size_t>(valley)] = 100;
        judge(
            call, [&](int r) { return r == valley                          ? 1
                                      : r == valley - 1 || r == valley + 1 ? 11
                                                                           : 31; }, 1);
    }
}

void fill(Call& call, Dice& dice, Filling filling)
{
    const auto u16 = [](std::uint32_t value) { return static_cast<std::uint16_t>(value); };
    // Often none without a candidate, sometimes none with one.
    const std::uint32_t unseen = dice.up_to(4);
    for (std::uint16_t& cost : call.costs)
        cost = dice.up_to(3) < unseen && unseen > 1 ? kNone : u16(draw(dice, filling, kWorstCost));
    call.least = u16(draw(dice, filling, kWorstCost));
    // Small differences as well as large ones.
    const std::uint32_t narrow = dice.up_to(12);
    const std::uint32_t reach = std::uint32_t{kNone} - call.least;
    for (std::uint16_t& path : call.behind)
        path = u16(call.least + draw(dice, filling, reach >> narrow));
    call.behind[static_cast<std::size_t>(dice.between(call.first, call.axis - 1))] = call.least;
    std::fill_n(call.behind.begin(), call.first, kNone);
    call.penalty.large = u16(draw(dice, filling, kMaxPathStep) >> dice.up_to(6));
    call.penalty.small = u16(draw(dice, filling, call.penalty.large));
}

void compare(const Kernels& tested, Stand& stand, Dice& dice, Verdict& verdict)
{
    for (const Placement placement : kPlacements)
        for (const Filling filling : kFillings)
            for (int axis = kLanes; axis <= 256; axis += kLanes)
                for (int first = 0; first < kLanes; ++first) {
                    stand.begin(placement);
                    Call call(stand, axis, first);
                    fill(call, dice, filling);
                    const char* words =
                        stand.difference([&](int) { call.run(kScalarKernels, call.ahead.law, call.least_ahead.law); },
                                         [&](int) { call.run(tested, call.ahead.tested, call.least_ahead.tested); });
                    if (words[0] != 0)
                        note_fault(verdict, "%d positions from %d, %s, %s: %s", axis, first, word_for(filling),
                                   word_for(placement), words);
                    ++verdict.compared;
                }
}

double time(const Kernels& tested, Stand& stand)
{
    Dice dice{1};
    stand.begin(Placement::kFirst);
    Call call(stand, 64, 0);
    fill(call, dice, Filling::kRandom);
    return best_rate(call.axis, [&](int) { call.run(tested, call.ahead.tested, call.least_ahead.tested); });
}

} // namespace

const KernelProof kPathStepProof = {
    "path_step", "positions", [](const Kernels& a, const Kernels& b) { return a.path_step == b.path_step; },
    work,        compare,     time};

} // namespace dicot::proof
