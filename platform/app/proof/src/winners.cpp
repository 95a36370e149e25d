// Both views of the winners: along a pixel's costs, and along the diagonals.
#include "kernel_proof.h"

#include <algorithm>

namespace dicot::proof {
namespace {

constexpr std::uint16_t kNone = kNoCandidate;

std::size_t size_of(int n)
{
    return static_cast<std::size_t>(n);
}

struct LeftCall
{
    int n, axis;
    std::span<std::uint16_t> costs;
    Twin<Winner> out;

    LeftCall(Stand& stand, int pixels, int positions)
        : n(pixels), axis(positions), costs(stand.input<std::uint16_t>(size_of(n * axis))),
          out(stand.output<Winner>(size_of(n)))
    {
    }
    void run(const Kernels& kernels, bool law) const
    {
        kernels.winners((law ? out.law : out.tested).data(), costs.data(), n, axis);
    }
};

struct RightCall
{
    int n, axis;
    std::span<std::uint16_t> costs;
    Twin<std::uint16_t> cost, position;

    RightCall(Stand& stand, int pixels, int positions)
        : n(pixels), axis(positions), costs(stand.input<std::uint16_t>(size_of(n * axis))),
          cost(stand.output<std::uint16_t>(size_of(n + axis - 1))),
          position(stand.output<std::uint16_t>(size_of(n + axis - 1)))
    {
    }
    void run(const Kernels& kernels, bool law) const
    {
        kernels.right_winners((law ? cost.law : cost.tested).data(), (law ? position.law : position.tested).data(),
                              costs.data(), n, axis);
    }
};

void work_left(const Kernels& tested, Stand& stand, Verdict& verdict)
{
    struct Vector
    {
        std::array<std::uint16_t, 8> costs;
        Winner right;
    };
    constexpr Vector kVectors[] = {
        {{9, 8, 7, 3, 4, 9, 5, 6}, {3, 3, 5}}, // the 4 beside the winner is no rival
        {{3, 9, 9, 9, 9, 9, 9, 3}, {7, 3, 3}}, // the last of two that are equal; the other is the rival
        {{1, 9, 9, 2, 0, 0, 2, 9}, {5, 0, 1}}, // the 0 beside it and the 2 are none
        {{0, 1, 51200, 51200, 51200, 51200, 51200, 51200}, {0, 0, 51200}},
        {{kNone, kNone, 40000, 30000, 35000, kNone, kNone, kNone}, {3, 30000, kNone}}, // no rival
        {{kNone, kNone, kNone, kNone, kNone, kNone, kNone, 0}, {7, 0, kNone}},
        {{kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone}, {7, kNone, kNone}},
    };
    for (const Vector& vector : kVectors)
        for (const int before : {0, 8, 16, 24}) { // positions without a candidate
            constexpr int kPixels = 3;
            stand.begin(Placement::kLast);
            LeftCall call(stand, kPixels, before + 8);
            std::ranges::fill(call.costs, kNone);
            for (int i = 0; i < kPixels; ++i)
                std::ranges::copy(vector.costs, call.costs.begin() + (i * call.axis + before));
            if (const char* words = stand.trespass([&](int) { call.run(tested, false); }); words[0] != 0)
                note_fault(verdict, "worked vector %d: %s", verdict.worked, words);
            for (const Winner& found : call.out.tested)
                if (found.position != vector.right.position + before || found.cost != vector.right.cost ||
                    found.runner_up != vector.right.runner_up)
                    note_fault(verdict, "worked vector %d: winner %d of cost %d, rival %d; right is %d, %d, %d",
                               verdict.worked, found.position, found.cost, found.runner_up,
                               vector.right.position + before, vector.right.cost, vector.right.runner_up);
            ++verdict.worked;
        }
}

void work_right(const Kernels& tested, Stand& stand, Verdict& verdict)
{
    constexpr int kPixels = 3;
    // Entry j meets pixel 0 at r = j, pixel 1 at r = j - 1, pixel 2 at r = j - 2.
    constexpr std::uint16_t kCosts[kPixels][8] = {
        {5, 6, 7, kNone, 9, kNone, kNone, 4},
        {8, 7, 6, kNone, 9, 1, kNone, 4},
        {3, 2, kNone, 8, kNone, kNone, 3, 0},
    };
    struct Entry
    {
        std::uint16_t cost, position;
    };
    constexpr Entry kRight[kPixels + 8 - 1] = {
        {5, 0}, // 5 alone
        {6, 1}, // 6, 8
        {3, 0}, // 7, 7, 3
        {2, 1}, // -, 6, 2
        {9, 4}, // 9, -, -
        {8, 3}, // -, 9, 8
        {1, 5}, // -, 1, -
        {4, 7}, // 4, -, -
        {3, 6}, // 4 of pixel 1, 3 of pixel 2
        {0, 7}, // 0 alone
    };
    stand.begin(Placement::kLast);
    RightCall call(stand, kPixels, 8);
    for (int i = 0; i < kPixels; ++i)
        std::ranges::copy(kCosts[i], call.costs.begin() + 8 * i);
    const auto judge = [&](std::size_t j, Entry right) {
        if (call.cost.tested[j] != right.cost || call.position.tested[j] != right.position)
            note_fault(verdict, "worked vector %d: entry %zu is %d at %d, right is %d at %d", verdict.worked, j,
                       call.cost.tested[j], call.position.tested[j], right.cost, right.position);
        ++verdict.worked;
    };
    const auto run = [&] {
        if (const char* words = stand.trespass([&](int) { call.run(tested, false); }); words[0] != 0)
            note_fault(verdict, "worked vector %d: %s", verdict.worked, words);
    };
    run();
    for (std::size_t j = 0; j < std::size(kRight); ++j)
        judge(j, kRight[j]);
    // All equal: the larger position wins, which is the earlier pixel's.
    std::ranges::fill(call.costs, std::uint16_t{77});
    run();
    for (int j = 0; j < kPixels + 7; ++j)
        judge(size_of(j), {77, static_cast<std::uint16_t>(std::min(j, 7))});
    std::ranges::fill(call.costs, kNone);
    run();
    for (int j = 0; j < kPixels + 7; ++j)
        judge(size_of(j), {kNone, 0});
}

void fill(std::span<std::uint16_t> costs, Dice& dice, Filling filling)
{
    // Few different values make ties; unseen positions come alone and in plenty.
    const std::uint32_t most = kWorstCost >> (2 * dice.up_to(7));
    const std::uint32_t unseen = dice.up_to(5);
    for (std::uint16_t& cost : costs)
        cost = unseen > 0 && dice.up_to(4) < unseen - 1 ? kNone : static_cast<std::uint16_t>(draw(dice, filling, most));
}

template <typename Call>
void compare(const Kernels& tested, Stand& stand, Dice& dice, Verdict& verdict)
{
    const auto run_case = [&](int n, int axis, Filling filling, Placement placement) {
        stand.begin(placement);
        Call call(stand, n, axis);
        fill(call.costs, dice, filling);
        const char* words =
            stand.difference([&](int) { call.run(kScalarKernels, true); }, [&](int) { call.run(tested, false); });
        if (words[0] != 0)
            note_fault(verdict, "%d pixels, %d positions, %s, %s: %s", n, axis, word_for(filling), word_for(placement),
                       words);
        ++verdict.compared;
    };
    for (const Placement placement : kPlacements) {
        for (int n = 0; n <= 97; ++n)
            run_case(n, kLanes * (1 + n % 4), Filling::kRandom, placement);
        for (int axis = kLanes; axis <= 256; axis += kLanes)
            for (const Filling filling : kFillings)
                for (int again = 0; again < 4; ++again)
                    run_case(dice.between(1, 20), axis, filling, placement);
        run_case(1280, 128, Filling::kRandom, placement);
    }
}

template <typename Call>
double time(const Kernels& tested, Stand& stand)
{
    Dice dice{1};
    stand.begin(Placement::kFirst);
    Call call(stand, 640, 64);
    for (std::uint16_t& cost : call.costs)
        cost = static_cast<std::uint16_t>(dice.up_to(kWorstCost));
    return best_rate(1.0 * call.n * call.axis, [&](int) { call.run(tested, false); });
}

} // namespace

const KernelProof kWinnersProof = {
    "winners", "costs",           [](const Kernels& a, const Kernels& b) { return a.winners == b.winners; },
    work_left, compare<LeftCall>, time<LeftCall>};

const KernelProof kRightWinnersProof = {
    "right_winners",
    "costs",
    [](const Kernels& a, const Kernels& b) { return a.right_winners == b.right_winners; },
    work_right,
    compare<RightCall>,
    time<RightCall>};

} // namespace dicot::proof
