#include "ros_camera.h"

#include "rig_values.h"

#include "dicot/os/shown_path.h"

#include <charconv>
#include <cmath>
#include <string_view>

namespace dicot {
namespace {

using Kind = YamlEvents::Kind;
constexpr double kMmPerMetre = 1000.0;
constexpr std::string_view kPlumbBob = "plumb_bob";
constexpr std::string_view kRational = "rational_polynomial";

void add_matrix(std::string& text, const char* key, std::size_t rows, std::size_t columns, const double* values)
{
    text += std::string{key} + ":\n  rows: " + std::to_string(rows) + "\n  cols: " + std::to_string(columns) +
            "\n  data: [";
    for (std::size_t i = 0; i < rows * columns; ++i) {
        char digits[32]; // to_chars, not printf: a locale must not turn the point into a comma
        const auto end = std::to_chars(digits, digits + sizeof digits, values[i]);
        text.append(i > 0 ? ", " : "").append(digits, end.ptr);
    }
    text += "]\n";
}

/// Files hold five decimals and more. Makes the nearest rotation of a matrix that is one but for its rounding, by
/// Newton's iteration for the polar decomposition: X (3 - X^T X) / 2.
bool make_rotation(Matrix<3, 3>& m)
{
    constexpr double kRounded = 1e-3;
    for (int step = 0; step < 4; ++step) {
        Matrix<3, 3> correction{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                const double product = m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j];
                const double expected = i == j ? 1.0 : 0.0;
                if (!(std::fabs(product - expected) <= kRounded))
                    return false;
                correction[i][j] = expected + (expected - product) / 2;
            }
        const Matrix<3, 3> before = m;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                m[i][j] =
                    before[i][0] * correction[0][j] + before[i][1] * correction[1][j] + before[i][2] * correction[2][j];
    }
    const double volume = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                          m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                          m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return volume > 0;
}

Status check_model(YamlEvents& events, std::string_view key)
{
    if (events.kind() != Kind::kScalar || (events.scalar() != kPlumbBob && events.scalar() != kRational))
        return wrong_value(events, key, "plumb_bob or rational_polynomial, the lens models that are known here");
    events.next();
    return {};
}

Status take_key(YamlEvents& events, std::string_view key, RosCamera& file)
{
    if (key == "image_width")
        file.width = TRY(read_whole(events, key));
    else if (key == "image_height")
        file.height = TRY(read_whole(events, key));
    else if (key == "camera_matrix")
        return read_shaped(events, key, file.camera.intrinsic, "3 x 3");
    else if (key == "distortion_model")
        return check_model(events, key);
    else if (key == "distortion_coefficients")
        file.camera.distortion = TRY(read_distortion(events, key));
    else if (key == "rectification_matrix")
        return read_shaped(events, key, file.camera.rectifying, "3 x 3");
    else if (key == "projection_matrix")
        return read_shaped(events, key, file.camera.projection, "3 x 4");
    else
        events.skip_value();
    return events.status();
}

} // namespace

Result<RosCamera> parse_ros_camera(std::span<const std::byte> text, const char* name)
{
    YamlEvents events{text, name};
    if (events.kind() != Kind::kMapStart)
        return events.status().ok() ? events.fault("no camera's description: keys and values are expected")
                                    : events.status();
    events.next();
    RosCamera file;
    while (events.kind() == Kind::kScalar) {
        const KeyText key{events.scalar()};
        events.next();
        TRY(take_key(events, key.text(), file));
    }
    if (events.kind() != Kind::kMapEnd)
        return events.status().ok() ? events.fault("a key is expected") : events.status();
    events.next();
    TRY(Status{events.status()});
    const RigCamera& camera = file.camera;
    if (!camera.intrinsic || !camera.distortion || !camera.rectifying || !camera.projection || file.width < 1 ||
        file.height < 1 || file.width > kMaxRigPictureSide || file.height > kMaxRigPictureSide)
        return failure(Fault::kBadData,
                       "%s: image_width, image_height, camera_matrix, distortion_coefficients, rectification_matrix "
                       "or projection_matrix is missing or senseless: export the camera again",
                       shown_path(name));
    if (!make_rotation(*file.camera.rectifying))
        return failure(Fault::kBadData, "%s: rectification_matrix is no rotation: export the camera again",
                       shown_path(name));
    for (auto& row : *file.camera.projection) {
        row[3] *= kMmPerMetre;
        if (!std::isfinite(row[3]))
            return failure(Fault::kBadData, "%s: a length in projection_matrix is too large for any rig: mend it",
                           shown_path(name));
    }
    return file;
}

std::string ros_text_of(const RosCamera& file, const char* camera_name)
{
    const RigCamera& camera = file.camera;
    std::string text = "image_width: " + std::to_string(file.width) + "\nimage_height: " + std::to_string(file.height) +
                       "\ncamera_name: " + camera_name + "\n";
    add_matrix(text, "camera_matrix", 3, 3, (*camera.intrinsic)[0].data());
    const Distortion distortion = camera.distortion.value_or(Distortion{5, {}});
    const bool rational = distortion.count > 5;
    text.append("distortion_model: ").append(rational ? kRational : kPlumbBob).append("\n");
    add_matrix(text, "distortion_coefficients", 1, rational ? 8 : 5, distortion.at.data());
    add_matrix(text, "rectification_matrix", 3, 3, (*camera.rectifying)[0].data());
    Matrix<3, 4> projection = *camera.projection;
    for (auto& row : projection)
        row[3] /= kMmPerMetre;
    add_matrix(text, "projection_matrix", 3, 4, projection[0].data());
    return text;
}

} // namespace dicot
