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

/// A key's own copy: the event's text lives until the next event only. Longer keys than any that is known become empty.
class KeyText
{
public:
    explicit KeyText(std::string_view key)
    {
        if (key.size() <= kMostBytes)
            size_ = key.copy(text_, kMostBytes);
    }
    std::string_view text() const { return {text_, size_}; }

private:
    static constexpr std::size_t kMostBytes = 40;
    char text_[kMostBytes] = {};
    std::size_t size_ = 0;
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

/// A matrix of exactly the shape of `into`, which `shape` puts into words; refused where `into` is known already.
template <std::size_t Rows, std::size_t Columns>
Status read_shaped(YamlEvents& events, std::string_view key, std::optional<Matrix<Rows, Columns>>& into,
                   const char* shape)
{
    if (into)
        return wrong_value(events, key, "there once only");
    const RawMatrix raw = TRY(read_matrix(events, key));
    if (raw.rows != static_cast<int>(Rows) || raw.columns != static_cast<int>(Columns))
        return wrong_shape(events, key, raw, shape);
    into.emplace();
    for (std::size_t i = 0; i < Rows * Columns; ++i)
        (*into)[i / Columns][i % Columns] = raw.at[i];
    return {};
}

} // namespace dicot
