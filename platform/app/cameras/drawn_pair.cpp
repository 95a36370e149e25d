#include "drawn_pair.h"

#include "dicot/os/output_file.h"
#include "dicot/picture/write_picture.h"
#include "dicot/uvc/uvc_list.h"
#include "dicot/v4l2/v4l2_camera.h"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

namespace dicot::app {
namespace {

constexpr const char* kRig = R"(%YAML:1.0
---
# The rig of the drawn pair: rectified, 400 px, 60 mm.
id: "drawn-pair"
unit: mm
image_width: 320
image_height: 240
near_mm: 350
far_mm: 1200
P1: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 400., 0., 160., 0., 0., 400., 120., 0., 0., 0., 1., 0. ]
P2: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 400., 0., 160., -24000., 0., 400., 120., 0., 0., 0., 1., 0. ]
)";

/// An upright ellipse, parallel to the pictures; of the left picture, px.
struct Leaf
{
    int x, y, half_width, half_height;
    int disparity;
};

constexpr std::array kLeaves{Leaf{190, 120, 22, 60, 60}, Leaf{120, 100, 34, 26, 48}, Leaf{240, 80, 30, 22, 40},
                             Leaf{150, 180, 40, 18, 34}, Leaf{90, 60, 26, 30, 30}};
constexpr int kWallDisparity = 24;

bool is_on(const Leaf& leaf, int x, int y) noexcept
{
    const int dx = (x - leaf.x) * leaf.half_height;
    const int dy = (y - leaf.y) * leaf.half_width;
    const int radius = leaf.half_width * leaf.half_height;
    return dx * dx + dy * dy <= radius * radius;
}

/// Marks of 2 px, the same for whoever looks at this place of this surface.
Rgb8 paint(unsigned surface, int x, int y) noexcept
{
    std::uint32_t mark = static_cast<std::uint32_t>(x / 2 + 512) * 73856093U ^
                         static_cast<std::uint32_t>(y / 2) * 19349663U ^ surface * 83492791U;
    mark ^= mark >> 13;
    mark *= 0x5BD1E995U;
    mark ^= mark >> 15;
    const auto level = static_cast<std::uint8_t>(mark % 96);
    if (surface == kLeaves.size())
        return {static_cast<std::uint8_t>(110 + level), static_cast<std::uint8_t>(100 + level),
                static_cast<std::uint8_t>(90 + level)};
    return {static_cast<std::uint8_t>(30 + level / 2), static_cast<std::uint8_t>(90 + level),
            static_cast<std::uint8_t>(20 + level / 3)};
}

/// What is nearest at this place of the left picture (sees = 0) or of the right one (1).
Rgb8 look(int x, int y, int sees) noexcept
{
    for (unsigned i = 0; i < kLeaves.size(); ++i)
        if (const int at = x + sees * kLeaves[i].disparity; is_on(kLeaves[i], at, y))
            return paint(i, at, y);
    return paint(kLeaves.size(), x + sees * kWallDisparity, y);
}

} // namespace

void DrawnPair::draw(ImageView<Rgb8> left, ImageView<Rgb8> right) noexcept
{
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            left.at(x, y) = look(x, y, 0);
            right.at(x, y) = look(x, y, 1);
        }
}

DrawnRig::~DrawnRig()
{
    std::error_code ignored;
    if (!folder_.empty())
        std::filesystem::remove_all(folder_, ignored);
}

Status DrawnRig::open(Config& config)
{
    std::error_code error;
    std::string pattern = (std::filesystem::temp_directory_path(error) / "dicot-drawn-XXXXXX").string();
    if (error || ::mkdtemp(pattern.data()) == nullptr)
        return failure(Fault::kCannotCreate, "no temporary folder can be made for the drawn pair: set TMPDIR");
    folder_ = pattern;
    const std::size_t pixels = std::size_t{DrawnPair::kWidth} * DrawnPair::kHeight;
    std::vector<Rgb8> both(2 * pixels);
    const ImageView<Rgb8> left{both.data(), DrawnPair::kWidth, DrawnPair::kHeight};
    const ImageView<Rgb8> right{both.data() + pixels, DrawnPair::kWidth, DrawnPair::kHeight};
    DrawnPair::draw(left, right);
    TRY(write_png((folder_ + "/left.png").c_str(), left));
    TRY(write_png((folder_ + "/right.png").c_str(), right));
    OutputFile rig;
    config.rig.file = folder_ + "/rig.yaml";
    TRY(rig.open(config.rig.file.c_str()));
    TRY(rig.write(kRig, std::strlen(kRig)));
    TRY(rig.commit());
    config.cameras.left = config.cameras.right = {BoundBy::kReplay, folder_};
    return {};
}

bool no_camera_is_there()
{
    const V4l2Nodes nodes = list_v4l2_cameras();
    const Result<std::vector<UvcListed>> listed = list_uvc_cameras();
    return nodes.count == 0 && nodes.denied == 0 && (!listed.ok() || listed.value().empty());
}

} // namespace dicot::app
