#include "dicot/rig/ros_files.h"

#include "rig_values.h"

#include "dicot/os/input_file.h"
#include "dicot/os/output_file.h"
#include "dicot/os/shown_path.h"

#include <charconv>
#include <new>
#include <string_view>
#include <vector>

namespace dicot {
namespace {

using Kind = YamlEvents::Kind;
constexpr double kMmPerMetre = 1000.0;

struct CameraFile
{
    int width = 0;
    int height = 0;
    RigCamera camera;
};

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

std::string text_of(const RigFile& rig, const RigCamera& camera, const char* camera_name)
{
    std::string text = "image_width: " + std::to_string(rig.width) + "\nimage_height: " + std::to_string(rig.height) +
                       "\ncamera_name: " + camera_name + "\n";
    add_matrix(text, "camera_matrix", 3, 3, (*camera.intrinsic)[0].data());
    const Distortion distortion = camera.distortion.value_or(Distortion{5, {}});
    const std::size_t count = distortion.count > 5 ? 8 : 5;
    text += std::string{"distortion_model: "} + (count == 8 ? "rational_polynomial" : "plumb_bob") + "\n";
    add_matrix(text, "distortion_coefficients", 1, count, distortion.at.data());
    add_matrix(text, "rectification_matrix", 3, 3, (*camera.rectifying)[0].data());
    Matrix<3, 4> projection = *camera.projection;
    for (auto& row : projection)
        row[3] /= kMmPerMetre;
    add_matrix(text, "projection_matrix", 3, 4, projection[0].data());
    return text;
}

template <std::size_t Rows, std::size_t Columns>
Status take_matrix(YamlEvents& events, std::string_view key, std::optional<Matrix<Rows, Columns>>& into,
                   const char* shape)
{
    const RawMatrix raw = TRY(read_matrix(events, key));
    if (raw.rows != static_cast<int>(Rows) || raw.columns != static_cast<int>(Columns))
        return wrong_shape(events, key, raw, shape);
    into.emplace();
    for (std::size_t i = 0; i < Rows * Columns; ++i)
        (*into)[i / Columns][i % Columns] = raw.at[i];
    return {};
}

Status take_key(YamlEvents& events, std::string_view key, CameraFile& file)
{
    if (key == "image_width")
        file.width = TRY(read_whole(events, key));
    else if (key == "image_height")
        file.height = TRY(read_whole(events, key));
    else if (key == "camera_matrix")
        return take_matrix(events, key, file.camera.intrinsic, "3 x 3");
    else if (key == "distortion_coefficients")
        file.camera.distortion = TRY(read_distortion(events, key));
    else if (key == "rectification_matrix")
        return take_matrix(events, key, file.camera.rectifying, "3 x 3");
    else if (key == "projection_matrix")
        return take_matrix(events, key, file.camera.projection, "3 x 4");
    else
        events.skip_value();
    return events.status();
}

Result<CameraFile> read_camera(const std::string& path)
{
    InputFile input;
    TRY(input.open(path.c_str()));
    if (input.size_bytes() > kMaxRigFileBytes)
        return failure(Fault::kBadData, "%s: a camera file has 1 MiB at most: give the folder of a camera_info pair",
                       shown_path(path.c_str()));
    std::vector<std::byte> text(static_cast<std::size_t>(input.size_bytes()));
    const std::size_t size = TRY(input.read(text));
    YamlEvents events{std::span{text}.first(size), path.c_str()};
    if (events.kind() != Kind::kMapStart)
        return events.status().ok() ? events.fault("no camera's description: keys and values are expected")
                                    : events.status();
    events.next();
    CameraFile file;
    while (events.kind() == Kind::kScalar) {
        const std::string key{events.scalar()};
        events.next();
        TRY(take_key(events, key, file));
    }
    if (events.kind() != Kind::kMapEnd)
        return events.status().ok() ? events.fault("a key is expected") : events.status();
    if (!file.camera.intrinsic || !file.camera.distortion || !file.camera.rectifying || !file.camera.projection ||
        file.width < 1 || file.height < 1 || file.width > kMaxRigPictureSide || file.height > kMaxRigPictureSide)
        return failure(Fault::kBadData,
                       "%s: image_width, image_height, camera_matrix, distortion_coefficients, rectification_matrix "
                       "or projection_matrix is missing or senseless: export the camera again",
                       shown_path(path.c_str()));
    for (auto& row : *file.camera.projection)
        row[3] *= kMmPerMetre;
    return file;
}

/// The transpose of `a` times `b`.
template <std::size_t Columns>
Matrix<3, Columns> back_turned(const Matrix<3, 3>& a, const Matrix<3, Columns>& b)
{
    Matrix<3, Columns> result{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < Columns; ++j)
            result[i][j] = a[0][i] * b[0][j] + a[1][i] * b[1][j] + a[2][i] * b[2][j];
    return result;
}

} // namespace

Status write_ros_files(const RigFile& rig, const std::string& folder, const char* name)
{
    for (const RigCamera* camera : {&rig.left, &rig.right}) {
        if (!camera->intrinsic || !camera->rectifying || !camera->projection)
            return failure(Fault::kBadData,
                           "%s: K, R1, R2, P1 or P2 is missing, which camera_info needs: give a rig file with K1, K2, "
                           "R and T",
                           shown_path(name));
        for (std::size_t i = 8; camera->distortion && i < camera->distortion->at.size(); ++i)
            if (camera->distortion->at[i] != 0)
                return failure(Fault::kBadData,
                               "%s: camera_info holds 8 distortion coefficients at most: calibrate with fewer",
                               shown_path(name));
    }
    OutputFile left, right;
    const std::string left_text = text_of(rig, rig.left, "left"), right_text = text_of(rig, rig.right, "right");
    TRY(left.open((folder + "/left.yaml").c_str()));
    TRY(right.open((folder + "/right.yaml").c_str()));
    TRY(left.write(left_text.data(), left_text.size()));
    TRY(right.write(right_text.data(), right_text.size()));
    TRY(left.commit());
    return right.commit();
}

Result<RigFile> read_ros_files(const std::string& folder)
{
    try {
        CameraFile left = TRY(read_camera(folder + "/left.yaml"));
        CameraFile right = TRY(read_camera(folder + "/right.yaml"));
        if (left.width != right.width || left.height != right.height)
            return failure(
                Fault::kBadData,
                "%s: left.yaml is for %d x %d px and right.yaml for %d x %d: export both from one calibration",
                shown_path(folder.c_str()), left.width, left.height, right.width, right.height);
        const double focal = (*right.camera.projection)[0][0];
        if (!(focal > 0))
            return failure(Fault::kBadData,
                           "%s: right.yaml has a senseless focal length in projection_matrix: export it again",
                           shown_path(folder.c_str()));
        RigFile rig;
        rig.width = left.width;
        rig.height = left.height;
        rig.rotation = back_turned(*right.camera.rectifying, *left.camera.rectifying);
        const Matrix<3, 1> shift =
            back_turned(*right.camera.rectifying, Matrix<3, 1>{{{(*right.camera.projection)[0][3] / focal}, {0}, {0}}});
        rig.translation_mm = {shift[0][0], shift[1][0], shift[2][0]};
        if (!(shift[0][0] < 0))
            return failure(Fault::kBadData,
                           "%s: P[0,3] of right.yaml must be negative: left.yaml and right.yaml are swapped, or of one "
                           "camera alone",
                           shown_path(folder.c_str()));
        rig.left = left.camera;
        rig.right = right.camera;
        return rig;
    } catch (const std::bad_alloc&) {
        return failure(Fault::kOsError, "%s: no memory to read its camera files", shown_path(folder.c_str()));
    }
}

} // namespace dicot
