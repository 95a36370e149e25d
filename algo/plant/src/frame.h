// Points of a view in mm, and in the ground frame.
#pragma once

#include "dicot/plant/ground.h"
#include "dicot/plant/plant_view.h"
#include "vec3.h"

#include <cstddef>

namespace dicot {

inline Vec3 point_mm(const PlantView& view, std::size_t i)
{
    const CloudPoint& point = view.cloud.points[i];
    const double step = view.mm_per_step();
    return {point.x * step, point.y * step, point.z * step};
}

inline Vec3 in_ground(const GroundFrame& ground, const Vec3& camera_mm)
{
    const Vec3 from = camera_mm - vec3(ground.origin_mm);
    return {dot(from, vec3(ground.right)), dot(from, vec3(ground.away)), dot(from, vec3(ground.up))};
}

} // namespace dicot
