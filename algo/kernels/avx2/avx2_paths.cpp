#include "dicot/kernels/kernels.h"

#include <immintrin.h>

// Paths and winners. Everything but the kernels has internal linkage: see the note on vector files in kernels.h.
namespace dicot {

std::uint16_t avx2_path_step(std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                             std::uint16_t least, PathPenalty penalty, int first, int axis);
void avx2_winners(Winner* out, const std::uint16_t* costs, int n, int axis);
void avx2_right_winners(std::uint16_t* cost, std::uint16_t* position, const std::uint16_t* costs, int n, int axis);

namespace {

using Vec = __m256i;

#define DICOT_LOAD(pointer) _mm256_loadu_si256(reinterpret_cast<const __m256i*>(pointer))
#define DICOT_STORE(pointer, value) _mm256_storeu_si256(reinterpret_cast<__m256i*>(pointer), value)

// A row of positions in vectors of 16; where only 8 are left, the upper half reads as kNoCandidate.
Vec load_half(const std::uint16_t* from)
{
    return _mm256_inserti128_si256(_mm256_set1_epi16(-1), _mm_loadu_si128(reinterpret_cast<const __m128i*>(from)), 0);
}

void store_half(std::uint16_t* to, Vec values)
{
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm256_castsi256_si128(values));
}

int least_lane(Vec values)
{
    const __m128i halves = _mm_min_epu16(_mm256_castsi256_si128(values), _mm256_extracti128_si256(values, 1));
    return _mm_extract_epi16(_mm_minpos_epu16(halves), 0);
}

int largest_lane(Vec values)
{
    return 0xFFFF - least_lane(_mm256_xor_si256(values, _mm256_set1_epi16(-1)));
}

Vec same_everywhere(int value)
{
    return _mm256_set1_epi16(static_cast<short>(value));
}

Vec ramp()
{
    return _mm256_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

// The values before and after each lane's; kNoCandidate comes in at the end.
Vec lanes_before(Vec values)
{
    const Vec low = _mm256_permute2x128_si256(_mm256_set1_epi16(-1), values, 0x20);
    return _mm256_alignr_epi8(values, low, 14);
}

Vec lanes_after(Vec values)
{
    const Vec high = _mm256_permute2x128_si256(values, _mm256_set1_epi16(-1), 0x21);
    return _mm256_alignr_epi8(high, values, 2);
}

struct Path
{
    Vec worst, small, jump, least;

    Vec step(Vec costs, Vec same, Vec before, Vec after) const
    {
        const Vec near = _mm256_adds_epu16(_mm256_min_epu16(before, after), small);
        const Vec best = _mm256_min_epu16(_mm256_min_epu16(same, near), jump);
        return _mm256_add_epi16(_mm256_min_epu16(costs, worst), _mm256_sub_epi16(best, least));
    }
};

// Adding 1 makes kNoCandidate the smallest value, and subtracting it again with saturation leaves 0.
Vec worst_cost(const std::uint16_t* costs, Vec padding, int axis)
{
    const Vec one = _mm256_set1_epi16(1);
    Vec most = _mm256_setzero_si256();
    int r = 0;
    for (; r + 16 <= axis; r += 16, padding = _mm256_setzero_si256())
        most = _mm256_max_epu16(most, _mm256_add_epi16(_mm256_or_si256(DICOT_LOAD(costs + r), padding), one));
    if (r < axis)
        most = _mm256_max_epu16(most, _mm256_add_epi16(_mm256_or_si256(load_half(costs + r), padding), one));
    return _mm256_subs_epu16(same_everywhere(largest_lane(most)), one);
}

} // namespace

std::uint16_t avx2_path_step(std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                             std::uint16_t least, PathPenalty penalty, int first, int axis)
{
    const Vec padding = _mm256_cmpgt_epi16(same_everywhere(first), ramp());
    const Path path = {worst_cost(costs, padding, axis), same_everywhere(penalty.small),
                       same_everywhere(least + penalty.large), same_everywhere(least)};
    Vec least_ahead = _mm256_set1_epi16(-1);
    int r = 0;
    for (; r + 16 <= axis; r += 16) {
        const Vec same = DICOT_LOAD(behind + r);
        const Vec before = r == 0 ? lanes_before(same) : DICOT_LOAD(behind + r - 1);
        const Vec after = r + 16 == axis ? lanes_after(same) : DICOT_LOAD(behind + r + 1);
        Vec values = path.step(DICOT_LOAD(costs + r), same, before, after);
        if (r == 0)
            values = _mm256_or_si256(values, padding);
        DICOT_STORE(ahead + r, values);
        least_ahead = _mm256_min_epu16(least_ahead, values);
    }
    if (r < axis) {
        const Vec same = load_half(behind + r);
        const Vec before = r == 0 ? lanes_before(same) : load_half(behind + r - 1);
        Vec values = path.step(load_half(costs + r), same, before, lanes_after(same));
        if (r == 0)
            values = _mm256_or_si256(values, padding);
        store_half(ahead + r, values);
        const Vec upper = _mm256_set_m128i(_mm_set1_epi16(-1), _mm_setzero_si128());
        least_ahead = _mm256_min_epu16(least_ahead, _mm256_or_si256(values, upper));
    }
    return static_cast<std::uint16_t>(least_lane(least_ahead));
}

namespace {

// The least costs so far of each lane and where they were; the later one of two that are equal.
struct Best
{
    Vec cost, position;

    void meet(Vec costs, Vec positions)
    {
        cost = _mm256_min_epu16(cost, costs);
        position = _mm256_blendv_epi8(position, positions, _mm256_cmpeq_epi16(cost, costs));
    }
};

} // namespace

void avx2_winners(Winner* out, const std::uint16_t* costs, int n, int axis)
{
    const Vec lanes = _mm256_set1_epi16(16);
    const Vec two = _mm256_set1_epi16(2);
    for (int i = 0; i < n; ++i, costs += axis) {
        Best best = {_mm256_set1_epi16(-1), _mm256_setzero_si256()};
        Vec positions = ramp();
        int r = 0;
        for (; r + 16 <= axis; r += 16, positions = _mm256_add_epi16(positions, lanes))
            best.meet(DICOT_LOAD(costs + r), positions);
        if (r < axis)
            best.meet(load_half(costs + r), positions);
        const int cost = least_lane(best.cost);
        const Vec winning = _mm256_cmpeq_epi16(best.cost, same_everywhere(cost));
        // Without any candidate a lane beyond the axis may have won.
        const int last = largest_lane(_mm256_and_si256(best.position, winning));
        const int position = last < axis ? last : axis - 1;

        Vec rivals = _mm256_set1_epi16(-1);
        Vec distance = _mm256_sub_epi16(ramp(), same_everywhere(position));
        for (r = 0; r + 16 <= axis; r += 16, distance = _mm256_add_epi16(distance, lanes)) {
            const Vec beside = _mm256_cmpgt_epi16(two, _mm256_abs_epi16(distance));
            rivals = _mm256_min_epu16(rivals, _mm256_or_si256(DICOT_LOAD(costs + r), beside));
        }
        if (r < axis) {
            const Vec beside = _mm256_cmpgt_epi16(two, _mm256_abs_epi16(distance));
            rivals = _mm256_min_epu16(rivals, _mm256_or_si256(load_half(costs + r), beside));
        }
        out[i].position = static_cast<std::uint16_t>(position);
        out[i].cost = static_cast<std::uint16_t>(cost);
        out[i].runner_up = static_cast<std::uint16_t>(least_lane(rivals));
    }
}

void avx2_right_winners(std::uint16_t* cost, std::uint16_t* position, const std::uint16_t* costs, int n, int axis)
{
    if (n == 0)
        return;
    for (int j = 0; j < n + axis - 1; ++j) {
        cost[j] = kNoCandidate;
        position[j] = 0;
    }
    for (int i = 0; i < n; ++i, costs += axis, ++cost, ++position) {
        Vec positions = ramp();
        int r = 0;
        for (; r + 16 <= axis; r += 16, positions = _mm256_add_epi16(positions, _mm256_set1_epi16(16))) {
            Best best = {DICOT_LOAD(costs + r), positions}; // one that was there before wins a tie
            best.meet(DICOT_LOAD(cost + r), DICOT_LOAD(position + r));
            DICOT_STORE(cost + r, best.cost);
            DICOT_STORE(position + r, best.position);
        }
        if (r < axis) {
            Best best = {load_half(costs + r), positions};
            best.meet(load_half(cost + r), load_half(position + r));
            store_half(cost + r, best.cost);
            store_half(position + r, best.position);
        }
    }
}

#undef DICOT_LOAD
#undef DICOT_STORE

} // namespace dicot
