// Runs one kernel of one level over and over, so that an instruction counter sees little else:
//   kernel_alone LEVEL KERNEL REPEATS      prints how many units of work one repeat is
#include "dicot/kernels/kernels.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

using namespace dicot;

constexpr int kPixels = 64;
constexpr int kDisparities = 64;

long aggregate(const Kernels& kernels, int repeats)
{
    constexpr int kRight = kPixels + kDisparities - 1;
    const std::vector<PairU16> left(kMaxWindow * kPixels, {20000, 30000});
    const std::vector<PairU16> right(kMaxWindow * kRight, {10000, 5000});
    const std::vector<PairU16> costs((kPixels + kMaxWindow - 1) * kDisparities, {100, 50});
    std::vector<std::uint32_t> numerator(kPixels * kDisparities), denominator(kPixels * kDisparities);
    for (int i = 0; i < repeats; ++i)
        kernels.aggregate({left.data(), right.data(), costs.data(), numerator.data(), denominator.data(), kPixels,
                           kRight, kMaxWindow, kPixels, kDisparities});
    return 2L * kMaxWindow * kPixels * kDisparities;
}

long support_weights(const Kernels& kernels, int repeats)
{
    const std::vector<PairS16> la(kPixels, {800, 5}), b(kPixels, {7, 0});
    const std::vector<std::uint16_t> colour(kColourTableAllocation, 20000);
    std::vector<PairU16> out(kPixels);
    const LabRow row = {la.data(), b.data()};
    for (int i = 0; i < repeats; ++i)
        kernels.support_weights(out.data(), kPixels, row, row, row, colour.data(), {16000, 15000});
    return 2L * kPixels;
}

long match_cost(const Kernels& kernels, int repeats)
{
    const std::vector<std::uint8_t> plane(kPixels + kDisparities, 90);
    const CostRow row = {plane.data(), plane.data(), plane.data(), plane.data()};
    const CostTables tables = {};
    std::vector<std::uint16_t> out(2 * kPixels * kDisparities);
    for (int i = 0; i < repeats; ++i)
        kernels.match_cost(out.data(), kPixels, kDisparities, row, row, tables);
    return long{kPixels} * kDisparities;
}

long normalise(const Kernels& kernels, int repeats)
{
    constexpr int kCount = kPixels * kDisparities;
    const std::vector<std::uint32_t> numerator(kCount, 1234567), denominator(kCount, 54321);
    std::vector<std::uint16_t> out(kCount);
    for (int i = 0; i < repeats; ++i)
        kernels.normalise(out.data(), numerator.data(), denominator.data(), kCount);
    return kCount;
}

/// Costs that fall and rise, so that places are won and lost.
std::vector<std::uint16_t> wavy_costs(int count)
{
    std::vector<std::uint16_t> costs;
    for (int i = 0; i < count; ++i)
        costs.push_back(static_cast<std::uint16_t>(20000 + i * 7919 % 9973));
    return costs;
}

long path_step(const Kernels& kernels, int repeats)
{
    const std::vector<std::uint16_t> costs = wavy_costs(kDisparities);
    std::vector<std::uint16_t> behind = costs, ahead(kDisparities);
    for (int i = 0; i < repeats; ++i)
        kernels.path_step(ahead.data(), costs.data(), behind.data(), 20000, {600, 2400}, 0, kDisparities);
    return kDisparities;
}

long winners(const Kernels& kernels, int repeats)
{
    const std::vector<std::uint16_t> costs = wavy_costs(kPixels * kDisparities);
    std::vector<Winner> out(kPixels);
    for (int i = 0; i < repeats; ++i)
        kernels.winners(out.data(), costs.data(), kPixels, kDisparities);
    return long{kPixels} * kDisparities;
}

long right_winners(const Kernels& kernels, int repeats)
{
    const std::vector<std::uint16_t> costs = wavy_costs(kPixels * kDisparities);
    std::vector<std::uint16_t> cost(kPixels + kDisparities - 1), position(cost.size());
    for (int i = 0; i < repeats; ++i)
        kernels.right_winners(cost.data(), position.data(), costs.data(), kPixels, kDisparities);
    return long{kPixels} * kDisparities;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 4)
        return 64;
    const Kernels* const kernels =
        dicot::kernels_for(std::strcmp(argv[1], "neon") == 0 ? CpuLevel::kNeon : CpuLevel::kScalar);
    const std::string kernel = argv[2];
    const int repeats = std::atoi(argv[3]);
    if (kernels == nullptr)
        return 69;
    const auto run = kernel == "aggregate"         ? aggregate
                     : kernel == "support_weights" ? support_weights
                     : kernel == "match_cost"      ? match_cost
                     : kernel == "path_step"       ? path_step
                     : kernel == "winners"         ? winners
                     : kernel == "right_winners"   ? right_winners
                                                   : normalise;
    std::printf("%ld\n", run(*kernels, repeats));
}
