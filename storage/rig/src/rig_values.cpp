#include "rig_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace dicot {
namespace {

using Kind = YamlEvents::Kind;
constexpr int kMostKeyBytes = 40;

/// Finite numbers in the C locale, as FileStorage writes them: "1.", "-2.5e-03", "+7".
bool number_of(std::string_view text, double& number)
{
    if (text.starts_with('+'))
        text.remove_prefix(1);
    const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
    return end.ec == std::errc{} && end.ptr == text.data() + text.size() && std::isfinite(number);
}

int shown_bytes(std::string_view key)
{
    return static_cast<int>(std::min<std::size_t>(key.size(), kMostKeyBytes));
}

Status read_data(YamlEvents& events, std::string_view key, RawMatrix& matrix)
{
    if (events.kind() != Kind::kListStart)
        return wrong_value(events, key, "a matrix with a list of numbers in 'data'");
    events.next();
    matrix.count = 0;
    while (events.kind() == Kind::kScalar) {
        if (matrix.count == RawMatrix::kMostNumbers)
            return wrong_value(events, key, "a matrix of 16 numbers at most");
        if (!number_of(events.scalar(), matrix.at[matrix.count++]))
            return wrong_value(events, key, "finite numbers in 'data'");
        events.next();
    }
    if (events.kind() != Kind::kListEnd)
        return wrong_value(events, key, "finite numbers in 'data'");
    events.next();
    return {};
}

} // namespace

Status wrong_value(const YamlEvents& events, std::string_view key, const char* expected)
{
    if (!events.status().ok())
        return events.status();
    char sentence[160];
    std::snprintf(sentence, sizeof sentence, "%.*s must be %s", shown_bytes(key), key.data(), expected);
    return events.fault(sentence);
}

Status wrong_shape(const YamlEvents& events, std::string_view key, const RawMatrix& found, const char* expected)
{
    char sentence[160];
    std::snprintf(sentence, sizeof sentence, "%.*s is a %d x %d matrix and must be %s", shown_bytes(key), key.data(),
                  found.rows, found.columns, expected);
    return events.fault(sentence);
}

Result<double> read_number(YamlEvents& events, std::string_view key)
{
    double number = 0;
    if (events.kind() != Kind::kScalar || !number_of(events.scalar(), number))
        return wrong_value(events, key, "a finite number");
    events.next();
    return number;
}

Result<int> read_whole(YamlEvents& events, std::string_view key)
{
    double number = 0;
    if (events.kind() != Kind::kScalar || !number_of(events.scalar(), number) || std::fabs(number) > 1e9 ||
        number != std::floor(number))
        return wrong_value(events, key, "a whole number");
    events.next();
    return static_cast<int>(number);
}

Result<RawMatrix> read_matrix(YamlEvents& events, std::string_view key)
{
    RawMatrix matrix;
    if (events.kind() != Kind::kMapStart)
        return wrong_value(events, key, "an !!opencv-matrix with rows, cols, dt and data");
    events.next();
    while (events.kind() == Kind::kScalar) {
        const std::string_view field = events.scalar();
        const bool rows = field == "rows";
        const bool columns = field == "cols";
        const bool type = field == "dt";
        const bool data = field == "data";
        events.next();
        if (rows)
            matrix.rows = TRY(read_whole(events, key));
        else if (columns)
            matrix.columns = TRY(read_whole(events, key));
        else if (data)
            TRY(read_data(events, key, matrix));
        else if (type && events.kind() == Kind::kScalar && events.scalar() != "d" && events.scalar() != "f")
            return wrong_value(events, key, "a matrix of dt d or f");
        else
            events.skip_value();
    }
    if (events.kind() != Kind::kMapEnd)
        return wrong_value(events, key, "an !!opencv-matrix with rows, cols, dt and data");
    if (matrix.rows < 1 || matrix.columns < 1 || matrix.rows > RawMatrix::kMostNumbers ||
        matrix.columns > RawMatrix::kMostNumbers || matrix.rows * matrix.columns != matrix.count)
        return wrong_value(events, key, "a matrix with as many numbers as rows x cols");
    events.next();
    return matrix;
}

Status read_size(YamlEvents& events, std::string_view key, int& width, int& height)
{
    if (events.kind() != Kind::kListStart)
        return wrong_value(events, key, "a list of width and height");
    events.next();
    width = TRY(read_whole(events, key));
    height = TRY(read_whole(events, key));
    if (events.kind() != Kind::kListEnd)
        return wrong_value(events, key, "a list of width and height");
    events.next();
    return events.status();
}

Result<Distortion> read_distortion(YamlEvents& events, std::string_view key)
{
    const RawMatrix raw = TRY(read_matrix(events, key));
    const int n = raw.count;
    if ((raw.rows != 1 && raw.columns != 1) || (n != 4 && n != 5 && n != 8 && n != 12 && n != 14))
        return wrong_shape(events, key, raw, "one row of 4, 5, 8, 12 or 14 coefficients");
    Distortion distortion;
    distortion.count = n;
    for (int i = 0; i < n; ++i)
        distortion.at[static_cast<std::size_t>(i)] = raw.at[i];
    return distortion;
}

Result<std::array<double, 3>> read_vector(YamlEvents& events, std::string_view key)
{
    const RawMatrix raw = TRY(read_matrix(events, key));
    if (raw.count != 3 || (raw.rows != 1 && raw.columns != 1))
        return wrong_shape(events, key, raw, "3 x 1");
    return std::array<double, 3>{raw.at[0], raw.at[1], raw.at[2]};
}

} // namespace dicot
