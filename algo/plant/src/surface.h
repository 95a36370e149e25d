// The canopy as a surface over its part of the picture: where it is torn, and how far each cell is from the next tear.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/plant/canopy.h"
#include "dicot/plant/plant_view.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// Cells of the canopy's bounding box, with a margin of two cells that hold nothing: neighbours need no check.
struct Surface
{
    enum Cell : std::uint8_t
    {
        kNothing,
        kPoint,
        kBridge, ///< no point was seen here, but the surface goes on behind: a hole that the matcher left
        kOther   ///< a point that is no canopy
    };
    /// Bits of `torn`: the surface ends between this cell and its neighbour.
    static constexpr std::uint8_t kRight = 1, kBelow = 2, kLeft = 4, kAbove = 8;
    static constexpr int kMargin = 2;
    static constexpr int kUnit = 5; ///< of `inside_px5`: chamfer distances 5 and 7, Borgefors 1986

    int left = 0, top = 0; ///< of the view, at cell (0, 0)
    int width = 0, height = 0;
    double focal_px = 0;
    std::span<std::uint8_t> cell;
    std::span<std::uint8_t> plant; ///< of kPoint and kBridge
    std::span<float> inverse;      ///< focal length by depth, 1 / mm: linear in the picture where the surface is flat
    std::span<std::uint8_t> torn;  ///< of kPoint and kBridge
    std::span<std::int16_t> inside_px5; ///< distance to the next tear, in fifths of a px

    std::size_t cells() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    bool holds(std::size_t i) const { return cell[i] == kPoint || cell[i] == kBridge; }
    std::int32_t point(const PlantView& view, std::size_t i) const
    {
        const int x = left + static_cast<int>(i % static_cast<std::size_t>(width));
        const int y = top + static_cast<int>(i / static_cast<std::size_t>(width));
        return x < 0 || y < 0 || x >= view.point.width || y >= view.point.height ? PlantView::kNoPoint
                                                                                 : view.point.at(x, y);
    }
};

/// A surface without cells where there is no canopy.
Surface surface_of(const PlantView& view, const Canopy& canopy, Arena& arena);

} // namespace dicot
