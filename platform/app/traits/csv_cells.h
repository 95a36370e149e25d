// Cells of tables that dicot writes.
#pragma once

#include "dicot/plant/traits.h"

#include <string>

namespace dicot::app {

/// Six digits; nothing where it is not known.
std::string csv_cell(double value);
/// As shown(), in quotes where it must be, and with a ' before a first = + - or @, which a spreadsheet would run as a
/// formula (OWASP, CSV Injection): names come from boards and paths.
std::string csv_cell(const std::string& text);

/// ",NAME,NAME_sd" for each column of plant_columns() or leaf_columns().
template <typename Columns>
std::string measured_names(const Columns& columns)
{
    std::string names;
    for (const auto& column : columns)
        names += std::string{","} + column.name + "," + column.name + "_sd";
    return names;
}

template <typename Columns, typename Traits>
std::string measured_cells(const Columns& columns, const Traits& traits)
{
    std::string cells;
    for (const auto& column : columns)
        cells += "," + csv_cell((traits.*column.measured).value) + "," + csv_cell((traits.*column.measured).sd);
    return cells;
}

} // namespace dicot::app
