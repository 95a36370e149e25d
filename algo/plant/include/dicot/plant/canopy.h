// What is green, above the ground, and which plant it belongs to.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/plant/ground.h"
#include "dicot/plant/plant_box.h"
#include "dicot/plant/plant_view.h"

#include <cstdint>
#include <span>

namespace dicot {

/// One number a point, in the cloud's order: 1 .. plant_count, or 0. Fruits, stems and green petioles are canopy too.
struct Canopy
{
    std::span<std::uint8_t> plant;
    int plant_count = 0;
};

/// The plane that the most points lie on with the fewest below it: bench, floor or lawn (Kind::kBench), from the foot
/// of the camera's perpendicular, `away` as the camera looks. Where no plane within 65 degrees of the camera's down
/// direction holds a tenth of the points, one within 35 degrees of its axis may, for cameras that look straight down
/// (`away` is then the picture's upper edge); not where more stands before it at the picture's lower edge than at the
/// upper one: a wall. Kind::kNone otherwise.
GroundFrame find_ground(const PlantView& view, Arena& arena);

/// Green points above the ground, in groups with gaps of 100 mm between them, numbered from left to right; groups of
/// less than a fifth of the largest, or of less than 200 points, are strays: 0, or 255 with `with_strays`, for
/// put_in_boxes() to take.
Canopy find_canopy(const PlantView& view, const GroundFrame& ground, Arena& arena, bool with_strays = false);

/// Numbers the canopy by the box that holds a point, the first that does; what stands in none is no canopy.
void put_in_boxes(const PlantView& view, const GroundFrame& ground, std::span<const PlantBox> boxes, Canopy& canopy);

/// Where soil is seen under the canopy, z = 0 moves up to it (Kind::kSoil, bench_mm).
void stand_on_soil(const PlantView& view, const Canopy& canopy, GroundFrame& ground, Arena& arena);

} // namespace dicot
