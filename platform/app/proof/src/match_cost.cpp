#include "kernel_proof.h"

#include <algorithm>

namespace dicot::proof {
namespace {

struct Row
{
    std::span<std::uint8_t> red, green, blue, census;
    CostRow view() const { return {red.data(), green.data(), blue.data(), census.data()}; }
};

Row take_row(Stand& stand, int n)
{
    const auto size = static_cast<std::size_t>(n);
    return {stand.input<std::uint8_t>(size), stand.input<std::uint8_t>(size), stand.input<std::uint8_t>(size),
            stand.input<std::uint8_t>(size)};
}

// The output ends with its last cost: the uint16 beside that one belongs to the other row, and here to nobody.
std::size_t output_size(int n, int disparities)
{
    return n == 0 ? 0 : static_cast<std::size_t>(n) * static_cast<std::size_t>(disparities) * 2 - 1;
}

struct Call
{
    int n, disparities;
    Row left, right;
    CostTables* tables;
    Twin<std::uint16_t> out;

    Call(Stand& stand, int pixels, int positions)
        : n(pixels), disparities(positions), left(take_row(stand, n)),
          right(take_row(stand, n == 0 ? 0 : n + disparities - 1)), tables(stand.input<CostTables>(1).data()),
          out(stand.output<std::uint16_t>(output_size(n, disparities)))
    {
    }
    void run(const Kernels& kernels, std::span<std::uint16_t> to) const
    {
        kernels.match_cost(to.data(), n, disparities, left.view(), right.view(), *tables);
    }
};

void work(const Kernels& tested, Stand& stand, Verdict& verdict)
{
    // difference[d] = floor(d / 7), at most 109; census[h] = 11 h, at most 88; what pads the tables is 255.
    // The left pixel is (200, 100, 50) with census 10110010; eight right ones:
    struct Vector
    {
        std::uint8_t red, green, blue, census, cost;
    };
    constexpr Vector kVectors[] = {
        {200, 100, 50, 0b10110010, 0},  // the same pixel
        {201, 100, 50, 0b10110010, 0},  // 1 / 7
        {200, 107, 50, 0b10110010, 1},  // 7 / 7
        {200, 100, 50, 0b10110011, 11}, // one bit
        {190, 110, 60, 0b01001101, 92}, // 30 / 7 = 4, eight bits 88
        {0, 0, 0, 0b00000000, 94},      // 350 / 7 = 50, four bits 44
        {255, 255, 255, 0b11111111, 103}, // (55 + 155 + 205) / 7 = 59, four bits 44
        {60, 255, 185, 0b00110000, 83}, // (140 + 155 + 135) / 7 = 61, two bits 22
    };
    constexpr std::uint16_t kUntouched = 0xBEEF;
    stand.begin(Placement::kLast);
    Call call(stand, 1, 8);
    std::ranges::fill(call.tables->difference, std::uint8_t{255});
    std::ranges::fill(call.tables->census, std::uint8_t{255});
    for (int d = 0; d <= 765; ++d)
        call.tables->difference[d] = static_cast<std::uint8_t>(d / 7);
    for (int h = 0; h <= 8; ++h)
        call.tables->census[h] = static_cast<std::uint8_t>(11 * h);
    call.left.red[0] = 200;
    call.left.green[0] = 100;
    call.left.blue[0] = 50;
    call.left.census[0] = 0b10110010;
    for (std::size_t r = 0; r < 8; ++r) {
        call.right.red[r] = kVectors[r].red;
        call.right.green[r] = kVectors[r].green;
        call.right.blue[r] = kVectors[r].blue;
        call.right.census[r] = kVectors[r].census;
    }
    std::ranges::fill(call.out.tested, kUntouched);
    if (const char* words = stand.trespass([&](int) { call.run(tested, call.out.tested); }); words[0] != 0)
        note_fault(verdict, "worked vectors: %s", words);
    for (std::size_t r = 0; r < 8; ++r) {
        if (call.out.tested[2 * r] != kVectors[r].cost)
            note_fault(verdict, "worked vector %zu: cost %d, right is %d", r, call.out.tested[2 * r], kVectors[r].cost);
        if (r < 7 && call.out.tested[2 * r + 1] != kUntouched)
            note_fault(verdict, "worked vector %zu: the other row's cost was overwritten", r);
        ++verdict.worked;
    }
}

void fill(Call& call, Dice& dice, Filling pixels, Filling costs)
{
    const auto u8 = [](std::uint32_t value) { return static_cast<std::uint8_t>(value); };
    for (const Row* row : {&call.left, &call.right})
        for (const auto& plane : {row->red, row->green, row->blue, row->census})
            for (std::uint8_t& value : plane)
                value = u8(draw(dice, pixels, 255));
    const std::uint32_t most_census = draw(dice, costs, kCostMax);
    for (std::uint8_t& cost : call.tables->difference)
        cost = u8(draw(dice, costs, kCostMax - most_census));
    for (std::uint8_t& cost : call.tables->census)
        cost = u8(draw(dice, costs, most_census));
}

void compare(const Kernels& tested, Stand& stand, Dice& dice, Verdict& verdict)
{
    const auto run_case = [&](int n, int disparities, Filling pixels, Filling costs, Placement placement) {
        stand.begin(placement);
        Call call(stand, n, disparities);
        fill(call, dice, pixels, costs);
        const char* words = stand.difference([&](int) { call.run(kScalarKernels, call.out.law); },
                                             [&](int) { call.run(tested, call.out.tested); });
        if (words[0] != 0)
            note_fault(verdict, "%d pixels, %d disparities, pixels %s, costs %s, %s: %s", n, disparities,
                       word_for(pixels), word_for(costs), word_for(placement), words);
        ++verdict.compared;
    };
    for (const Placement placement : kPlacements) {
        for (int n = 0; n <= 97; ++n)
            run_case(n, 8 * (1 + n % 4), Filling::kRandom, Filling::kRandom, placement);
        for (int disparities = 8; disparities <= 256; disparities += 8)
            for (const Filling pixels : kFillings)
                for (const Filling costs : kFillings)
                    run_case(dice.between(1, 5), disparities, pixels, costs, placement);
        run_case(641, 64, Filling::kRandom, Filling::kRandom, placement);
    }
}

double time(const Kernels& tested, Stand& stand)
{
    Dice dice{1};
    stand.begin(Placement::kFirst);
    Call call(stand, 640, 64);
    fill(call, dice, Filling::kRandom, Filling::kRandom);
    return best_rate(1.0 * call.n * call.disparities, [&](int) { call.run(tested, call.out.tested); });
}

} // namespace

const KernelProof kMatchCostProof = {
    "match_cost", "costs", [](const Kernels& a, const Kernels& b) { return a.match_cost == b.match_cost; }, work,
    compare, time};

} // namespace dicot::proof
