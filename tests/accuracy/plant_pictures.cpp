#include "plant_pictures.h"

#include "dicot/cloud/disparity_picture.h"
#include "dicot/cloud/render.h"
#include "dicot/cloud/triangulate.h"
#include "dicot/os/memory_block.h"
#include "dicot/picture/write_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace dicot::test {
namespace {

using scenes::Picture;

void write(const std::string& name, const Picture& picture)
{
    std::filesystem::create_directories(DICOT_PICTURES_DIR);
    const std::string path = std::string(DICOT_PICTURES_DIR) + "/" + name + ".png";
    const Status written = write_png(path.c_str(), picture.view());
    EXPECT_TRUE(written.ok()) << written.message();
}

Picture blank(int width, int height)
{
    return {width, height, std::vector<Rgb8>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
}

Rgb8 colour_of(float error_mm)
{
    const float size = std::fabs(error_mm);
    return std::isnan(size) ? Rgb8{255, 0, 255}
           : size <= 1      ? Rgb8{0, 150, 0}
           : size <= 3      ? Rgb8{150, 220, 60}
           : size <= 10     ? Rgb8{255, 150, 0}
                            : Rgb8{255, 0, 0};
}

Rgb8 darkened(Rgb8 pixel)
{
    const auto third = [](std::uint8_t level) { return static_cast<std::uint8_t>(level / 3); };
    return {third(pixel.r), third(pixel.g), third(pixel.b)};
}

/// The leaves' place in the picture, and in depth.
struct Frame
{
    int left, top, right, bottom; ///< px, the last ones belong to it
    double nearest_mm, farthest_mm;

    int width() const { return right - left + 1; }
    int height() const { return bottom - top + 1; }
    void widen(int px, int picture_width, int picture_height)
    {
        left = std::max(0, left - px);
        top = std::max(0, top - px);
        right = std::min(picture_width - 1, right + px);
        bottom = std::min(picture_height - 1, bottom + px);
    }
    template <typename Pixel>
    ImageView<Pixel> of(ImageView<Pixel> whole) const
    {
        return {whole.row(top) + left, width(), height(), whole.stride};
    }
};

Frame frame_of(const TrueDepth& truth)
{
    Frame frame{truth.width, truth.height, -1, -1, 1e9, 0};
    for (int y = 0; y < truth.height; ++y)
        for (int x = 0; x < truth.width; ++x) {
            const auto i = static_cast<std::size_t>(y * truth.width + x);
            if (!truth.leaf[i])
                continue;
            frame.left = std::min(frame.left, x);
            frame.right = std::max(frame.right, x);
            frame.top = std::min(frame.top, y);
            frame.bottom = std::max(frame.bottom, y);
            frame.nearest_mm = std::min(frame.nearest_mm, static_cast<double>(truth.mm[i]));
            frame.farthest_mm = std::max(frame.farthest_mm, static_cast<double>(truth.mm[i]));
        }
    return frame;
}

} // namespace

void draw_match(const std::string& name, const DisparityMap& map, const Picture& flat_left, const RectifiedView& view,
                const TrueDepth& truth)
{
    Picture disparities = blank(flat_left.width, flat_left.height);
    paint_disparities(map, disparities.view());
    write(name + "_disparity", disparities);

    constexpr int kAroundPx = 40;
    constexpr double kAroundMm = 100;
    Frame frame = frame_of(truth);
    frame.widen(kAroundPx, truth.width, truth.height);
    const WorkingRange range{frame.nearest_mm - kAroundMm, frame.farthest_mm + kAroundMm};
    RigGeometry rig = view.geometry();
    rig.cx_px -= frame.left;
    rig.cy_px -= frame.top;
    rig.width = frame.width();
    rig.height = frame.height();
    DisparityMap cut = map;
    cut.relative = frame.of(map.relative);
    cut.confidence = frame.of(map.confidence);
    const Triangulation how = triangulation_for(rig, range, grid_for(rig, range).value()).value();
    Picture views = blank(2 * rig.width, rig.height);
    const auto draw = [&](Arena& arena) {
        const Triangulated made = triangulate(cut, frame.of(flat_left.view()), how, arena);
        if (arena.measuring())
            lay_out_render(arena, rig.width, rig.height);
        else
            render_two_views(made.cloud, rig.focal_px, views.view(), arena);
    };
    Arena measure;
    draw(measure);
    const MemoryBlock block = MemoryBlock::map(measure.peak()).value();
    Arena arena(block.bytes());
    draw(arena);
    write(name + "_cloud", views);
}

void draw_errors(const std::string& name, const PlantPair& pair, const TrueDepth& truth)
{
    const Frame frame = frame_of(truth);
    const int width = frame.width();
    Picture drawn = blank(3 * width, frame.height());
    for (int y = 0; y < drawn.height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto i = static_cast<std::size_t>((y + frame.top) * truth.width + x + frame.left);
            drawn.view().at(x, y) = pair.left.pixels[i];
            int panel = 1;
            for (const RawDepth* depth : {&pair.ours, &pair.peer})
                drawn.view().at(x + width * panel++, y) =
                    truth.leaf[i] ? colour_of(depth->mm[i] - truth.mm[i]) : darkened(pair.left.pixels[i]);
        }
    write(name + "_error", drawn);
}

} // namespace dicot::test
