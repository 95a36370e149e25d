// What method best adds to a row of costs, against plain loops over the whole picture.
#include "column_paths.h"
#include "paths.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

namespace dicot::matching {
namespace {

constexpr int kWidth = 45;
constexpr int kDisparities = 13;

/// Noise seen from two sides, in memory of its own.
struct Stage
{
    std::vector<std::byte> block = std::vector<std::byte>(std::size_t{8} << 20);
    Arena arena{aligned(block)};
    Scene scene{};

    Stage(int height, int radius, double reach, const Kernels& kernels = kScalarKernels)
    {
        scene.kernels = &kernels;
        scene.width = kWidth;
        scene.height = height;
        scene.radius = radius;
        scene.disparities = kDisparities;
        scene.axis = 16;
        const auto window = static_cast<std::size_t>(2 * radius + 1);
        scene.left_spatial = arena.take<std::uint16_t>(window * window);
        scene.right_spatial = arena.take<std::uint16_t>(window * window);
        scene.left.lay_out(arena, kWidth, height, radius, radius);
        scene.right.lay_out(arena, kWidth, height, radius + scene.axis - 1, radius);
        fill_spatial_weights(scene.left_spatial.data(), scene.right_spatial.data(), radius, reach);
        scene.colour.fill(6);
        fill_costs(scene.costs, MatchCost::kAdCensus);
        const auto lab = std::make_unique<LabTables>();
        fill(*lab);
        std::mt19937 dice(11);
        const auto pixels = static_cast<std::size_t>(kWidth * height);
        for (Planes* const planes : {&scene.left, &scene.right}) {
            std::vector<Rgb8> noise(pixels);
            for (Rgb8& p : noise)
                p = {static_cast<std::uint8_t>(100 + dice() % 40), static_cast<std::uint8_t>(100 + dice() % 40),
                     static_cast<std::uint8_t>(100 + dice() % 40)};
            planes->fill_rows({noise.data(), kWidth, height}, 0, *lab, 0, height);
        }
        scene.right_edges.lay_out(arena, kWidth, height, scene.axis - 1);
        scene.right_edges.fill_rows(scene.right, 0, height);
    }

    static std::span<std::byte> aligned(std::vector<std::byte>& bytes)
    {
        void* start = bytes.data();
        std::size_t space = bytes.size();
        std::align(Arena::kAlignment, 1, start, space);
        return {static_cast<std::byte*>(start), space};
    }

    std::vector<std::vector<std::uint16_t>> rows()
    {
        CostRows costs;
        costs.lay_out(arena, scene);
        MatchTimes times;
        std::vector<std::vector<std::uint16_t>> all;
        for (int y = 0; y < scene.height; ++y) {
            const AggregatedRow row = costs.row(scene, y, times, nullptr);
            all.emplace_back(row.begin(), row.end());
        }
        return all;
    }
};

TEST(NearWindow, MixesInWhatAWindowOfSevenAloneWouldGive)
{
    constexpr int kHeight = 23;
    Stage wide(kHeight, 8, 17);
    Stage narrow(kHeight, NearWindow::kRadius, 4);
    Stage both(kHeight, 8, 17);
    both.scene.near_window = true;
    const auto far = wide.rows();
    const auto near = narrow.rows();
    const auto mixed = both.rows();
    int different = 0;
    for (std::size_t y = 0; y < kHeight; ++y)
        for (std::size_t i = 0; i < far[y].size(); ++i) {
            if (far[y][i] == kNoCandidate) {
                EXPECT_EQ(mixed[y][i], kNoCandidate);
                continue;
            }
            EXPECT_NEAR(mixed[y][i], 0.8 * far[y][i] + 0.2 * near[y][i],
                        0.51 + 0.001 * std::abs(far[y][i] - near[y][i]))
                << "row " << y << ", cost " << i;
            different += far[y][i] != near[y][i];
        }
    EXPECT_GT(different, 1000);
}

// The path from row `from` to row `to`, one row behind the other, in plain integers.
std::vector<std::vector<int>> plain_paths(const Scene& scene, const std::vector<std::vector<std::uint16_t>>& costs,
                                          int x, int from, int to)
{
    const int way = from <= to ? 1 : -1;
    const int first = scene.axis - scene.disparities;
    std::vector<int> behind(static_cast<std::size_t>(scene.axis), 0);
    std::vector<std::vector<int>> paths(static_cast<std::size_t>(scene.height));
    for (int y = from; y != to + way; y += way) {
        const auto own = [&](int r) {
            return int{costs[static_cast<std::size_t>(y)][static_cast<std::size_t>(x * scene.axis + r)]};
        };
        int worst = 0;
        for (int r = first; r < scene.axis; ++r)
            worst = std::max(worst, own(r) == kNoCandidate ? 0 : own(r));
        const auto edge = [&](const Planes& planes, int column) {
            return y != from && colour_edge(planes.lab(y), column, planes.lab(y - way), column, 12);
        };
        const int least = *std::min_element(behind.begin() + first, behind.end());
        std::vector<int> ahead(behind.size(), 0);
        for (int r = first; r < scene.axis; ++r) {
            const auto i = static_cast<std::size_t>(r);
            const int partner = x - (scene.axis - 1 - r);
            const int divisor = edge(scene.left, x) || (partner >= 0 && edge(scene.right, partner)) ? 8 : 1;
            const int small = kWorstCost / 100 / divisor;
            int best = std::min(behind[i], least + kWorstCost * 11 / 40 / divisor);
            if (r > first)
                best = std::min(best, behind[i - 1] + small);
            if (r + 1 < scene.axis)
                best = std::min(best, behind[i + 1] + small);
            ahead[i] = std::min(own(r), worst) + best - least;
        }
        paths[static_cast<std::size_t>(y)] = ahead;
        behind = ahead;
    }
    return paths;
}

TEST(ColumnPaths, AreTheMeanOfBothWaysWhateverTheWorkers)
{
    // Both chunks look ahead to the last row, so nothing is forgotten.
    constexpr int kHeight = ColumnPaths::kChunk + ColumnPaths::kAhead;
    static_assert(kHeight == 2 * ColumnPaths::kChunk);
    Stage stage(kHeight, 2, 17);
    const Scene& scene = stage.scene;
    const auto costs = stage.rows();
    for (const int workers : {1, 3}) {
        ColumnPaths paths;
        paths.lay_out(stage.arena, scene, workers);
        ASSERT_FALSE(stage.arena.overrun());
        for (int y = 0; y < kHeight; ++y)
            std::ranges::copy(costs[static_cast<std::size_t>(y)], paths.costs(scene, y).begin());
        for (int chunk = 0; chunk < 2; ++chunk)
            for (int worker = 0; worker < workers; ++worker)
                paths.walk(scene, chunk, worker, workers);
        for (int x = 0; x < kWidth; ++x) {
            const auto down = plain_paths(scene, costs, x, 0, kHeight - 1);
            const auto up = plain_paths(scene, costs, x, kHeight - 1, 0);
            for (int y = 0; y < kHeight; ++y)
                for (int r = scene.axis - kDisparities; r < scene.axis; ++r) {
                    const auto row = static_cast<std::size_t>(y);
                    const auto i = static_cast<std::size_t>(r);
                    const auto at = static_cast<std::size_t>(x * scene.axis + r);
                    const int own = costs[row][at];
                    const int right = own == kNoCandidate ? own : (down[row][i] + up[row][i]) / 2;
                    ASSERT_EQ(paths.costs(scene, y)[at], right) << x << ", " << y << ", position " << r;
                }
        }
    }
}

} // namespace
} // namespace dicot::matching
