// The traits by name: one table for files, curves and pictures.
#pragma once

#include "dicot/plant/traits.h"

#include <span>

namespace dicot::app {

struct PlantColumn
{
    const char* name; ///< with method and unit, as in files
    const char* unit; ///< "" : a number
    const char* drawn_unit;
    double drawn_units; ///< in one `unit`
    const char* words;
    Measured PlantTraits::*measured;
};

struct LeafColumn
{
    const char* name;
    Measured LeafTraits::*measured;
};

std::span<const PlantColumn> plant_columns();
std::span<const LeafColumn> leaf_columns();

} // namespace dicot::app
