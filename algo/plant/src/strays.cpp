#include "strays.h"

#include "frame.h"
#include "groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace dicot {
namespace {

constexpr double kGapMm = 100;
constexpr int kStrayShare = 20;

/// Space around a canopy, in cubes.
struct Cubes
{
    static constexpr int kMostAcross = 64;

    double side_mm = 20;
    Vec3 corner;
    std::array<int, 3> count{};

    explicit Cubes(const PlantView& view, std::span<const std::uint8_t> plant)
    {
        Vec3 least{HUGE_VAL, HUGE_VAL, HUGE_VAL}, most{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
        for (std::size_t i = 0; i < plant.size(); ++i) {
            if (!plant[i])
                continue;
            const Vec3 at = point_mm(view, i);
            least = {std::min(least.x, at.x), std::min(least.y, at.y), std::min(least.z, at.z)};
            most = {std::max(most.x, at.x), std::max(most.y, at.y), std::max(most.z, at.z)};
        }
        if (least.x > most.x)
            return;
        corner = least;
        const double across = std::max({most.x - least.x, most.y - least.y, most.z - least.z});
        side_mm = std::max(side_mm, across / (kMostAcross - 1));
        const auto cubes = [this](double length_mm) { return static_cast<int>(length_mm / side_mm) + 1; };
        count = {cubes(most.x - least.x), cubes(most.y - least.y), cubes(most.z - least.z)};
    }

    std::size_t all() const
    {
        return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
               static_cast<std::size_t>(count[2]);
    }
    std::int32_t at(int x, int y, int z) const { return (z * count[1] + y) * count[0] + x; }
    std::int32_t of(const Vec3& point) const
    {
        const auto place = [this](double from_mm, int cubes) {
            return std::clamp(static_cast<int>(from_mm / side_mm), 0, cubes - 1);
        };
        return at(place(point.x - corner.x, count[0]), place(point.y - corner.y, count[1]),
                  place(point.z - corner.z, count[2]));
    }
};

constexpr int squared(int n)
{
    return n * n;
}

/// Joins a cube with all that are within kGapMm behind it.
void join(const Cubes& cubes, int x, int y, int z, std::span<const std::int32_t> held, Groups& groups)
{
    const int reach = std::max(1, static_cast<int>(kGapMm / cubes.side_mm));
    const auto last = [&](int from, int axis) {
        return std::min(from + reach, cubes.count[static_cast<std::size_t>(axis)] - 1);
    };
    for (int w = z; w <= last(z, 2); ++w)
        for (int v = std::max(0, y - reach); v <= last(y, 1); ++v)
            for (int u = std::max(0, x - reach); u <= last(x, 0); ++u)
                if (squared(u - x) + squared(v - y) + squared(w - z) <= squared(reach) &&
                    held[static_cast<std::size_t>(cubes.at(u, v, w))] > 0)
                    groups.join(cubes.at(x, y, z), cubes.at(u, v, w));
}

} // namespace

void drop_strays(const PlantView& view, Canopy& canopy, Arena& arena)
{
    const std::size_t mark = arena.used();
    const Cubes cubes(view, canopy.plant);
    const std::span<std::int32_t> held = arena.take<std::int32_t>(cubes.all());
    const std::span<std::int32_t> parent = arena.take<std::int32_t>(cubes.all());
    if (!arena.overrun() && cubes.all() > 0) {
        std::ranges::fill(held, 0);
        std::array<std::int64_t, UINT8_MAX + 1> whole{};
        for (std::size_t i = 0; i < canopy.plant.size(); ++i)
            if (canopy.plant[i]) {
                ++held[static_cast<std::size_t>(cubes.of(point_mm(view, i)))];
                ++whole[canopy.plant[i]];
            }
        Groups groups(parent);
        for (int z = 0; z < cubes.count[2]; ++z)
            for (int y = 0; y < cubes.count[1]; ++y)
                for (int x = 0; x < cubes.count[0]; ++x)
                    if (held[static_cast<std::size_t>(cubes.at(x, y, z))] > 0)
                        join(cubes, x, y, z, held, groups);
        // What a group holds stands at its root, which is its first cube and so comes before the others.
        for (std::size_t cube = 0; cube < held.size(); ++cube)
            if (const auto root = static_cast<std::size_t>(groups.root(static_cast<std::int32_t>(cube))); root != cube)
                held[root] += held[cube];
        for (std::size_t i = 0; i < canopy.plant.size(); ++i)
            if (canopy.plant[i]) {
                const auto root = static_cast<std::size_t>(groups.root(cubes.of(point_mm(view, i))));
                if (std::int64_t{held[root]} * kStrayShare < whole[canopy.plant[i]])
                    canopy.plant[i] = 0;
            }
    }
    arena.rewind(mark);
}

} // namespace dicot
