#include "plant_work.h"

#include "dicot/base/arena.h"
#include "dicot/os/clock.h"
#include "dicot/os/shown_path.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace dicot::app {
namespace {

constexpr std::size_t kGridBytes = PlantView::kMostCells * sizeof(std::int32_t) + (std::size_t{1} << 20);

double lap_s(std::int64_t& since_us)
{
    const std::int64_t now_us = monotonic_us();
    return static_cast<double>(now_us - std::exchange(since_us, now_us)) * 1e-6;
}

/// Leaves stay while their traits are measured; what finding them took beside is free again by then.
std::size_t block_bytes(const PlantView& view)
{
    const std::size_t points = view.cloud.points.size();
    Arena stays;
    (void)stays.take<std::uint16_t>(points);
    (void)stays.take<std::uint8_t>(points);
    (void)stays.take<std::uint8_t>(UINT16_MAX);
    return std::max(segment_leaves_bytes(view), stays.peak() + traits_bytes(points, UINT16_MAX, UINT8_MAX));
}

/// Of a cloud of too few points: all places are empty.
Result<Leaves> no_leaves(const PlantView& view, std::size_t places, Arena& arena)
{
    Leaves leaves;
    leaves.leaf = arena.take<std::uint16_t>(view.cloud.points.size());
    leaves.plant = arena.take<std::uint8_t>(view.cloud.points.size());
    if (arena.overrun())
        return failure(Fault::kConfig, "too little memory to look for leaves");
    std::ranges::fill(leaves.leaf, Leaves::kNone);
    std::ranges::fill(leaves.plant, std::uint8_t{0});
    leaves.plant_count = static_cast<int>(places);
    return leaves;
}

} // namespace

const char* name_of(GroundFrame::Kind kind)
{
    switch (kind) {
    case GroundFrame::Kind::kSoil:
        return "soil";
    case GroundFrame::Kind::kBench:
        return "bench";
    case GroundFrame::Kind::kNone:
        break;
    }
    return "none";
}

Result<PlantWork> PlantWork::make(const PointCloud& cloud, const char* name, std::span<const PlantPlace> places,
                                  double far_mm)
{
    const auto named = [&](const Status& why) {
        return failure(why.fault(), "%s: %s", shown_path(name), why.message());
    };
    PlantWork work;
    std::int64_t since_us = monotonic_us();
    work.grid_ = TRY(MemoryBlock::map(kGridBytes));
    Arena grid{work.grid_.bytes()};
    const Result<PlantView> view = plant_view(cloud, grid);
    if (!view.ok())
        return named(view.status());
    work.view_ = view.value();
    work.times_.view_s = lap_s(since_us);

    work.block_ = TRY(MemoryBlock::map(block_bytes(work.view_)));
    Arena arena{work.block_.bytes()};
    std::vector<PlantBox> boxes;
    for (const PlantPlace& place : places) {
        boxes.push_back(place.box);
        work.names_.push_back(place.name);
    }
    const Result<Leaves> leaves =
        work.view_.too_few ? no_leaves(work.view_, boxes.size(), arena) : segment_leaves(work.view_, boxes, arena);
    if (!leaves.ok())
        return named(leaves.status());
    work.leaves_ = leaves.value();
    work.times_.leaves_s = lap_s(since_us);

    const Result<Traits> traits = measure_traits(work.view_, work.leaves_, arena, far_mm);
    if (!traits.ok())
        return named(traits.status());
    work.traits_ = traits.value();
    work.times_.traits_s = lap_s(since_us);
    work.memory_bytes_ = grid.peak() + arena.peak();
    return work;
}

std::string PlantWork::plant_name(int plant) const
{
    const auto at = static_cast<std::size_t>(plant - 1);
    return at < names_.size() ? names_[at] : "plant " + std::to_string(plant);
}

} // namespace dicot::app
