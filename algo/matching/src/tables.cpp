#include "tables.h"

#include "dicot/base/exact_math.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace dicot::matching {
namespace {

constexpr double kAlphaCensus = 5;      // eq. 12, bits
constexpr double kAlphaDifference = 15; // eq. 12, grey levels
constexpr double kTadThreshold = 40;    // eq. 9, grey levels

std::uint16_t rounded(double x)
{
    return static_cast<std::uint16_t>(x + 0.5);
}

} // namespace

void ColourWeights::fill(double gamma_color)
{
    table[0] = kLeftWeightOne;
    for (int i = 1; i < kColourTableSize; ++i) {
        // The squared distances that share this entry run from `from` to half an ulp below the next entry's.
        const auto bits = static_cast<std::uint32_t>(i + 127 * kColourSteps - 1) << 17;
        const double from = std::bit_cast<float>(bits);
        const double middle = from < kColourSteps ? from : from * (1.0 + 0.5 / kColourSteps);
        const double distance = std::sqrt(middle) / kLabScale;
        table[i] = rounded(kLeftWeightOne * exact_exp(-std::min(distance / gamma_color, 50.0)));
    }
    table[kColourTableSize] = 0;
}

std::uint16_t ColourWeights::between(LabRow p, int i, LabRow q, int j) const
{
    const int l = p.la[i].low - q.la[j].low;
    const int a = p.la[i].high - q.la[j].high;
    const int b = p.b[i].low - q.b[j].low;
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(l * l + a * a + b * b));
    const int index = static_cast<int>(bits >> 17) - (127 * kColourSteps - 1);
    return table[std::max(index, 0)];
}

void fill_spatial_weights(std::uint16_t* left, std::uint16_t* right, int radius, double gamma_space)
{
    for (int dy = -radius; dy <= radius; ++dy) {
        for (int dx = -radius; dx <= radius; ++dx) {
            const double weight = exact_exp(-std::min(std::sqrt(double(dx * dx + dy * dy)) / gamma_space, 50.0));
            *left++ = rounded(kLeftWeightOne * weight);
            *right++ = rounded(kRightWeightOne * weight);
        }
    }
}

void fill_costs(CostTables& tables, MatchCost cost)
{
    tables = {};
    if (cost == MatchCost::kTad) {
        for (int sum = 0; sum <= 765; ++sum)
            tables.difference[sum] =
                static_cast<std::uint8_t>(rounded(kCostMax * std::min(sum / (3 * kTadThreshold), 1.0)));
        return;
    }
    constexpr double kHalf = kCostMax / 2.0;
    for (int sum = 0; sum <= 765; ++sum)
        tables.difference[sum] =
            static_cast<std::uint8_t>(rounded(kHalf * (1.0 - exact_exp(-sum / 3.0 / kAlphaDifference))));
    for (int bits = 0; bits <= 8; ++bits)
        tables.census[bits] = static_cast<std::uint8_t>(rounded(kHalf * (1.0 - exact_exp(-bits / kAlphaCensus))));
}

} // namespace dicot::matching
