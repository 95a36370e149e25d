#include "refine.h"

#include "median.h"
#include "tables.h"

#include <algorithm>
#include <array>

namespace dicot::matching {
namespace {

/// Half the side of the window in which a filled pixel asks its neighbours.
constexpr int kVoteRadius = 17;

void fill_row(std::span<DispQ8> disparity, std::span<Verdict> verdict)
{
    const auto width = disparity.size();
    // Two sweeps: the nearest matched value from the left, then the smaller of it and the nearest one from the right.
    DispQ8 nearest = kDispMissing;
    for (std::size_t x = 0; x < width; ++x) {
        if (verdict[x] == Verdict::kMatched)
            nearest = disparity[x];
        else
            disparity[x] = nearest;
    }
    nearest = kDispMissing;
    for (std::size_t x = width; x-- > 0;) {
        if (verdict[x] == Verdict::kMatched) {
            nearest = disparity[x];
            continue;
        }
        if (nearest == kDispMissing || disparity[x] == kDispMissing)
            verdict[x] = Verdict::kUnseen;
        disparity[x] = std::min(disparity[x], nearest); // kDispMissing is the largest value
    }
}

/// The weighted median of the window of (x, y), to whole pixels, and the weighted mean of the values that share them.
DispQ8 weighted_median(ImageView<const DispQ8> map, const Maps& maps, const Planes& left, const ColourWeights& weights,
                       int x, int y)
{
    std::array<std::uint32_t, kMaxDisparities + 2> votes{};
    std::array<std::uint64_t, kMaxDisparities + 2> sums{};
    std::uint64_t total = 0;
    const LabRow centre = left.lab(y);
    for (int ny = std::max(y - kVoteRadius, 0); ny <= std::min(y + kVoteRadius, map.height - 1); ++ny) {
        const LabRow row = left.lab(ny);
        for (int nx = std::max(x - kVoteRadius, 0); nx <= std::min(x + kVoteRadius, map.width - 1); ++nx) {
            const Verdict verdict = maps.verdict.row(ny)[nx];
            if (verdict == Verdict::kUnseen)
                continue;
            // What was filled from both sides has half a vote.
            const std::uint32_t weight =
                std::uint32_t{weights.between(centre, x, row, nx)} >> (verdict == Verdict::kMatched ? 0 : 1);
            const DispQ8 value = map.row(ny)[nx];
            votes[value >> 8] += weight;
            sums[value >> 8] += std::uint64_t{weight} * value;
            total += weight;
        }
    }
    std::uint64_t passed = 0;
    std::size_t bin = 0;
    while (bin + 1 < votes.size() && (passed += votes[bin]) * 2 < total)
        ++bin;
    return votes[bin] == 0 ? map.row(y)[x] : static_cast<DispQ8>((sums[bin] + votes[bin] / 2) / votes[bin]);
}

} // namespace

void fill_empty_rows(ImageView<DispQ8> map)
{
    const auto copy_from = [&](int from, int to) { std::copy_n(map.row(from), map.width, map.row(to)); };
    int first = 0;
    while (first < map.height && map.row(first)[0] == kDispMissing)
        ++first;
    if (first == map.height) {
        for (int y = 0; y < map.height; ++y)
            std::fill_n(map.row(y), map.width, DispQ8{0});
        return;
    }
    for (int y = first; y-- > 0;)
        copy_from(first, y);
    for (int y = first + 1; y < map.height; ++y)
        if (map.row(y)[0] == kDispMissing)
            copy_from(y - 1, y);
}

void drop_unmatched(const Maps& maps)
{
    for (int y = 0; y < maps.disparity.height; ++y) {
        for (int x = 0; x < maps.disparity.width; ++x) {
            if (maps.verdict.row(y)[x] == Verdict::kMatched)
                continue;
            maps.disparity.row(y)[x] = kDispMissing;
            maps.confidence.row(y)[x] = 0;
        }
    }
}

void fill_gaps(const Maps& maps)
{
    const auto width = static_cast<std::size_t>(maps.disparity.width);
    for (int y = 0; y < maps.disparity.height; ++y) {
        fill_row({maps.disparity.row(y), width}, {maps.verdict.row(y), width});
        for (int x = 0; x < maps.disparity.width; ++x)
            if (maps.verdict.row(y)[x] != Verdict::kMatched)
                maps.confidence.row(y)[x] = 0;
    }
    fill_empty_rows(maps.disparity);
}

void smooth_evenly(const Maps& maps, Crew& crew)
{
    crew.run(maps.disparity.height, [&](int y) { median_row<1>(maps.disparity, y, maps.scratch.row(y)); });
    crew.run(maps.disparity.height,
             [&](int y) { std::copy_n(maps.scratch.row(y), maps.disparity.width, maps.disparity.row(y)); });
}

void smooth(const Maps& maps, const Planes& left, const ColourWeights& weights, Crew& crew)
{
    const int height = maps.disparity.height;
    crew.run(height, [&](int y) { median_row<2>(maps.disparity, y, maps.scratch.row(y)); });
    crew.run(height, [&](int y) {
        for (int x = 0; x < maps.disparity.width; ++x)
            maps.disparity.row(y)[x] = maps.verdict.row(y)[x] == Verdict::kMatched
                                           ? maps.scratch.row(y)[x]
                                           : weighted_median(maps.scratch, maps, left, weights, x, y);
    });
}

} // namespace dicot::matching
