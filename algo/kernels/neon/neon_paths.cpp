#include "dicot/kernels/kernels.h"

#include <arm_neon.h>

// Paths and winners, for aarch64 and armhf. Everything but the kernels has internal linkage: see the note on vector
// files in kernels.h.
namespace dicot {

std::uint16_t neon_path_step(std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                             std::uint16_t least, PathPenalty penalty, int first, int axis);
void neon_winners(Winner* out, const std::uint16_t* costs, int n, int axis);
void neon_right_winners(std::uint16_t* cost, std::uint16_t* position, const std::uint16_t* costs, int n, int axis);

namespace {

#if defined(__aarch64__)
std::uint16_t least_lane(uint16x8_t values)
{
    return vminvq_u16(values);
}
std::uint16_t largest_lane(uint16x8_t values)
{
    return vmaxvq_u16(values);
}
#else
std::uint16_t least_lane(uint16x8_t values)
{
    uint16x4_t least = vmin_u16(vget_low_u16(values), vget_high_u16(values));
    least = vpmin_u16(least, least);
    return vget_lane_u16(vpmin_u16(least, least), 0);
}
std::uint16_t largest_lane(uint16x8_t values)
{
    uint16x4_t most = vmax_u16(vget_low_u16(values), vget_high_u16(values));
    most = vpmax_u16(most, most);
    return vget_lane_u16(vpmax_u16(most, most), 0);
}
#endif

uint16x8_t ramp()
{
    static const std::uint16_t kRamp[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    return vld1q_u16(kRamp);
}

// Adding 1 makes kNoCandidate the smallest value, and subtracting it again with saturation leaves 0.
uint16x8_t worst_cost(const std::uint16_t* costs, uint16x8_t padding, int axis)
{
    const uint16x8_t one = vdupq_n_u16(1);
    uint16x8_t most = vaddq_u16(vorrq_u16(vld1q_u16(costs), padding), one);
    for (int r = 8; r < axis; r += 8)
        most = vmaxq_u16(most, vaddq_u16(vld1q_u16(costs + r), one));
    return vqsubq_u16(vdupq_n_u16(largest_lane(most)), one);
}

} // namespace

std::uint16_t neon_path_step(std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                             std::uint16_t least, PathPenalty penalty, int first, int axis)
{
    const uint16x8_t nothing = vdupq_n_u16(kNoCandidate);
    const uint16x8_t padding = vcltq_u16(ramp(), vdupq_n_u16(static_cast<std::uint16_t>(first)));
    const uint16x8_t worst = worst_cost(costs, padding, axis);
    const uint16x8_t small = vdupq_n_u16(penalty.small);
    const uint16x8_t jump = vdupq_n_u16(static_cast<std::uint16_t>(least + penalty.large));
    const uint16x8_t floor = vdupq_n_u16(least);
    uint16x8_t least_ahead = nothing;
    uint16x8_t previous = nothing;
    uint16x8_t same = vld1q_u16(behind);
    for (int r = 0; r < axis; r += 8) {
        const uint16x8_t next = r + 8 < axis ? vld1q_u16(behind + r + 8) : nothing;
        const uint16x8_t beside = vminq_u16(vextq_u16(previous, same, 7), vextq_u16(same, next, 1));
        const uint16x8_t best = vminq_u16(vminq_u16(same, vqaddq_u16(beside, small)), jump);
        const uint16x8_t own = vminq_u16(vld1q_u16(costs + r), worst);
        uint16x8_t values = vaddq_u16(own, vsubq_u16(best, floor));
        if (r == 0)
            values = vorrq_u16(values, padding);
        vst1q_u16(ahead + r, values);
        least_ahead = vminq_u16(least_ahead, values);
        previous = same;
        same = next;
    }
    return least_lane(least_ahead);
}

namespace {

// The least costs so far of each lane and where they were; the later one of two that are equal.
struct Best
{
    uint16x8_t cost, position;

    void meet(uint16x8_t costs, uint16x8_t positions)
    {
        const uint16x8_t later = vcleq_u16(costs, cost);
        cost = vminq_u16(cost, costs);
        position = vbslq_u16(later, positions, position);
    }
};

} // namespace

void neon_winners(Winner* out, const std::uint16_t* costs, int n, int axis)
{
    const uint16x8_t lanes = vdupq_n_u16(8);
    const uint16x8_t two = vdupq_n_u16(2);
    for (int i = 0; i < n; ++i, costs += axis) {
        uint16x8_t positions = ramp();
        Best best = {vld1q_u16(costs), positions};
        for (int r = 8; r < axis; r += 8) {
            positions = vaddq_u16(positions, lanes);
            best.meet(vld1q_u16(costs + r), positions);
        }
        const std::uint16_t cost = least_lane(best.cost);
        const uint16x8_t winning = vceqq_u16(best.cost, vdupq_n_u16(cost));
        const std::uint16_t position = largest_lane(vandq_u16(best.position, winning));

        const uint16x8_t middle = vdupq_n_u16(position);
        uint16x8_t rivals = vdupq_n_u16(kNoCandidate);
        positions = ramp();
        for (int r = 0; r < axis; r += 8, positions = vaddq_u16(positions, lanes)) {
            const uint16x8_t beside = vcltq_u16(vabdq_u16(positions, middle), two);
            rivals = vminq_u16(rivals, vorrq_u16(vld1q_u16(costs + r), beside));
        }
        out[i].position = position;
        out[i].cost = cost;
        out[i].runner_up = least_lane(rivals);
    }
}

void neon_right_winners(std::uint16_t* cost, std::uint16_t* position, const std::uint16_t* costs, int n, int axis)
{
    if (n == 0)
        return;
    for (int j = 0; j < n + axis - 1; ++j) {
        cost[j] = kNoCandidate;
        position[j] = 0;
    }
    for (int i = 0; i < n; ++i, costs += axis, ++cost, ++position) {
        uint16x8_t positions = ramp();
        for (int r = 0; r < axis; r += 8, positions = vaddq_u16(positions, vdupq_n_u16(8))) {
            Best best = {vld1q_u16(costs + r), positions}; // one that was there before wins a tie
            best.meet(vld1q_u16(cost + r), vld1q_u16(position + r));
            vst1q_u16(cost + r, best.cost);
            vst1q_u16(position + r, best.position);
        }
    }
}

} // namespace dicot
