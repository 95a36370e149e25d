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

} // namespace

void draw_match(const std::string& name, const DisparityMap& map, const Picture& flat_left, const RectifiedView& view)
{
    Picture disparities = blank(flat_left.width, flat_left.height);
    paint_disparities(map, disparities.view());
    write(name + "_disparity", disparities);

    const RigGeometry rig = view.geometry();
    const Triangulation how = triangulation_for(rig, kWorkingRange, grid_for(rig, kWorkingRange).value()).value();
    Picture views = blank(2 * flat_left.width, flat_left.height);
    const auto draw = [&](Arena& arena) {
        const Triangulated made = triangulate(map, flat_left.view(), how, arena);
        if (arena.measuring())
            lay_out_render(arena, flat_left.width, flat_left.height);
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
    int left = truth.width, right = -1, top = truth.height, bottom = -1;
    for (int y = 0; y < truth.height; ++y)
        for (int x = 0; x < truth.width; ++x)
            if (truth.leaf[static_cast<std::size_t>(y * truth.width + x)]) {
                left = std::min(left, x);
                right = std::max(right, x);
                top = std::min(top, y);
                bottom = std::max(bottom, y);
            }
    const int width = right - left + 1, height = bottom - top + 1;
    Picture drawn = blank(3 * width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto i = static_cast<std::size_t>((y + top) * truth.width + x + left);
            drawn.view().at(x, y) = pair.left.pixels[i];
            int panel = 1;
            for (const RawDepth* depth : {&pair.ours, &pair.peer})
                drawn.view().at(x + width * panel++, y) =
                    truth.leaf[i] ? colour_of(depth->mm[i] - truth.mm[i]) : darkened(pair.left.pixels[i]);
        }
    write(name + "_error", drawn);
}

} // namespace dicot::test
