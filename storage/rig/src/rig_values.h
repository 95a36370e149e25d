// The kinds of values that stand in a rig file.
#pragma once

#include "yaml_events.h"

#include "dicot/rig/rig_file.h"

#include <string_view>

namespace dicot {

/// A matrix as it stands in the file: rows x columns finite numbers, row by row.
struct RawMatrix
{
    static constexpr int kMostNumbers = 16;
    int rows = 0;
    int columns = 0;
    int count = 0;
    double at[kMostNumbers] = {};
};

// Each reads the value at the current event, moves past it, and names `key` when it refuses.
Result<double> read_number(YamlEvents& events, std::string_view key);
Result<int> read_whole(YamlEvents& events, std::string_view key);
Result<RawMatrix> read_matrix(YamlEvents& events, std::string_view key);
/// A list of two whole numbers.
Status read_size(YamlEvents& events, std::string_view key, int& width, int& height);

/// A matrix of one row or column, of 4, 5, 8, 12 or 14 numbers.
Result<Distortion> read_distortion(YamlEvents& events, std::string_view key);
/// A matrix of one row or column, of 3 numbers.
Result<std::array<double, 3>> read_vector(YamlEvents& events, std::string_view key);

Status wrong_value(const YamlEvents& events, std::string_view key, const char* expected);
Status wrong_shape(const YamlEvents& events, std::string_view key, const RawMatrix& found, const char* expected);

} // namespace dicot
