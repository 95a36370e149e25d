#include "plant_places.h"

#include "../accuracy/csv_table.h"

#include "dicot/os/shown_path.h"

#include <algorithm>
#include <array>
#include <limits>

namespace dicot::app {
namespace {

constexpr std::array<const char*, 6> kBounds{"min_x_mm", "min_y_mm", "min_z_mm", "max_x_mm", "max_y_mm", "max_z_mm"};

struct Columns
{
    std::size_t name = 0;
    std::array<std::size_t, 6> bound{};
};

Result<Columns> find_columns(const CsvTable& table, const char* shown)
{
    const auto find = [&](const char* name) -> Result<std::size_t> {
        if (const auto column = table.column(name))
            return *column;
        return failure(Fault::kBadData, "%s: it has no column %s: it needs name and, in mm, min_x_mm to max_z_mm",
                       shown, name);
    };
    Columns columns;
    columns.name = TRY(find("name"));
    for (std::size_t i = 0; i < kBounds.size(); ++i)
        columns.bound[i] = TRY(find(kBounds[i]));
    return columns;
}

Result<double> bound_in(const std::string& cell, double if_empty, const char* shown, int line)
{
    if (cell.empty())
        return if_empty;
    if (const auto number = number_in(cell))
        return *number;
    return failure(Fault::kBadData, "%s:%d: '%s' is no number of mm", shown, line, cell.substr(0, 40).c_str());
}

} // namespace

Result<std::vector<PlantPlace>> read_plant_places(const std::string& path)
{
    const char* shown = shown_path(path.c_str());
    const CsvTable table = TRY(read_csv(path));
    const Columns columns = TRY(find_columns(table, shown));
    constexpr std::size_t kMostPlants = 255;
    if (table.rows.empty() || table.rows.size() > kMostPlants)
        return failure(Fault::kBadData, "%s: %zu plants: name 1 to %zu", shown, table.rows.size(), kMostPlants);
    std::vector<PlantPlace> places;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const std::vector<std::string>& row = table.rows[i];
        const int line = table.lines[i];
        PlantPlace place{row[columns.name], {}};
        if (place.name.empty() ||
            std::ranges::any_of(places, [&](const auto& other) { return other.name == place.name; }))
            return failure(Fault::kBadData, "%s:%d: every plant needs a name of its own", shown, line);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            constexpr double kNoBound = std::numeric_limits<double>::infinity();
            place.box.min_mm[axis] = TRY(bound_in(row[columns.bound[axis]], -kNoBound, shown, line));
            place.box.max_mm[axis] = TRY(bound_in(row[columns.bound[axis + 3]], kNoBound, shown, line));
            if (place.box.min_mm[axis] >= place.box.max_mm[axis])
                return failure(Fault::kBadData, "%s:%d: the box of %s is empty: %s must be below %s", shown, line,
                               place.name.substr(0, 40).c_str(), kBounds[axis], kBounds[axis + 3]);
        }
        places.push_back(place);
    }
    return places;
}

} // namespace dicot::app
