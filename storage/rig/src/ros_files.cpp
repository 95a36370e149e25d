#include "dicot/rig/ros_files.h"

#include "ros_camera.h"

#include "dicot/os/input_file.h"
#include "dicot/os/output_file.h"
#include "dicot/os/shown_path.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <vector>

namespace dicot {
namespace {

// What rounding in a text file may have done to numbers that follow from each other.
constexpr double kSameTurn = 1e-9;

Result<std::vector<std::byte>> bytes_of(const std::string& path)
{
    InputFile input;
    TRY(input.open(path.c_str()));
    if (input.size_bytes() > kMaxRigFileBytes)
        return failure(Fault::kBadData, "%s: a camera file has 1 MiB at most: give the folder of a camera_info pair",
                       shown_path(path.c_str()));
    std::vector<std::byte> text(static_cast<std::size_t>(input.size_bytes()));
    text.resize(TRY(input.read(text)));
    return text;
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

Matrix<3, 3> rotation_between(const RigFile& rig)
{
    return back_turned(*rig.right.rectifying, *rig.left.rectifying);
}

std::array<double, 3> shift_between_mm(const RigFile& rig)
{
    const Matrix<3, 4>& projection = *rig.right.projection;
    const Matrix<3, 1> shift =
        back_turned(*rig.right.rectifying, Matrix<3, 1>{{{projection[0][3] / projection[0][0]}, {0}, {0}}});
    return {shift[0][0], shift[1][0], shift[2][0]};
}

/// Whether R and T can be told from the rectification, which is all that camera_info holds of them.
bool rectification_holds_the_rig(const RigFile& rig)
{
    const std::array<double, 3> shift = shift_between_mm(rig);
    double longest = 0;
    for (const double length : shift)
        longest = std::max(longest, std::fabs(length));
    bool same = true;
    for (std::size_t i = 0; i < 3; ++i) {
        same = same && (!rig.translation_mm || std::fabs((*rig.translation_mm)[i] - shift[i]) <= kSameTurn * longest);
        for (std::size_t j = 0; j < 3; ++j)
            same =
                same && (!rig.rotation || std::fabs((*rig.rotation)[i][j] - rotation_between(rig)[i][j]) <= kSameTurn);
    }
    return same;
}

Status check_for_ros(const RigFile& rig, const char* name)
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
    TRY(geometry_of(rig, name));
    if (!rectification_holds_the_rig(rig))
        return failure(Fault::kBadData,
                       "%s: R1, R2 and P2 do not belong to R and T: take R1, R2, P1, P2 and Q out of the file, and "
                       "they are computed again",
                       shown_path(name));
    return {};
}

} // namespace

Status write_ros_files(const RigFile& rig, const std::string& folder, const char* name)
{
    TRY(check_for_ros(rig, name));
    try {
        const std::string texts[] = {ros_text_of({rig.width, rig.height, rig.left}, "left"),
                                     ros_text_of({rig.width, rig.height, rig.right}, "right")};
        const auto files = std::make_unique<OutputFile[]>(2);
        TRY(files[0].open((folder + "/left.yaml").c_str()));
        TRY(files[1].open((folder + "/right.yaml").c_str()));
        for (std::size_t side = 0; side < 2; ++side) {
            TRY(files[side].write(texts[side].data(), texts[side].size()));
            TRY(files[side].sync());
        }
        TRY(files[0].commit());
        return files[1].commit();
    } catch (const std::bad_alloc&) {
        return failure(Fault::kOsError, "%s: no memory to write its camera files", shown_path(folder.c_str()));
    }
}

Result<RigFile> parse_ros(std::span<const std::byte> left_text, std::span<const std::byte> right_text,
                          const std::string& folder)
{
    const RosCamera left = TRY(parse_ros_camera(left_text, (folder + "/left.yaml").c_str()));
    const RosCamera right = TRY(parse_ros_camera(right_text, (folder + "/right.yaml").c_str()));
    const char* shown = shown_path(folder.c_str());
    if (left.width != right.width || left.height != right.height)
        return failure(Fault::kBadData,
                       "%s: left.yaml is for %d x %d px and right.yaml for %d x %d: export both from one calibration",
                       shown, left.width, left.height, right.width, right.height);
    RigFile rig;
    rig.width = left.width;
    rig.height = left.height;
    rig.left = left.camera;
    rig.right = right.camera;
    const double shift_px_mm = (*rig.right.projection)[0][3];
    if (!(shift_px_mm < 0))
        return failure(Fault::kBadData,
                       "%s: P[0,3] of right.yaml must be negative: left.yaml and right.yaml are swapped, or of one "
                       "camera alone",
                       shown);
    const RigGeometry geometry = TRY(geometry_of(rig, folder.c_str()));
    rig.rotation = rotation_between(rig);
    rig.translation_mm = shift_between_mm(rig);
    rig.reprojection = {{{1, 0, 0, -geometry.cx_px},
                         {0, 1, 0, -geometry.cy_px},
                         {0, 0, 0, geometry.focal_px},
                         {0, 0, 1 / geometry.baseline_mm, geometry.disparity_offset_px / geometry.baseline_mm}}};
    return rig;
}

Result<RigFile> read_ros_files(const std::string& folder)
{
    try {
        const std::vector<std::byte> left = TRY(bytes_of(folder + "/left.yaml"));
        const std::vector<std::byte> right = TRY(bytes_of(folder + "/right.yaml"));
        return parse_ros(left, right, folder);
    } catch (const std::bad_alloc&) {
        return failure(Fault::kOsError, "%s: no memory to read its camera files", shown_path(folder.c_str()));
    }
}

} // namespace dicot
