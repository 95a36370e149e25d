#include "scenes.h"

#include "dicot/picture/read_picture.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace dicot::scenes {
namespace {

[[noreturn]] void stop(const Status& status)
{
    std::fprintf(stderr, "%s\n", status.message());
    std::exit(status.exit_code());
}

Scene scene(const std::string& folder, const std::string& name, int disparities, int scale)
{
    const std::string base = std::string(DICOT_DATA_DIR) + "/" + folder + "/" + name + "/";
    Scene made{name, disparities, read(base + "left.png"), read(base + "right.png"), {}, {}, {}, {}};
    for (const Rgb8 p : read(base + "disp_left.png").pixels)
        made.truth.push_back(p.r == 0 ? -1.0 : p.r / double(scale));
    const auto mask = [&](const char* file) {
        std::vector<bool> counted;
        for (const Rgb8 p : read(base + file).pixels)
            counted.push_back(p.r == 255);
        return counted;
    };
    made.nonocc = mask("nonocc.png");
    made.all = mask("all.png");
    made.disc = mask("disc.png");
    return made;
}

} // namespace

bool data_present(const char* test)
{
    if (std::filesystem::is_directory(std::string(DICOT_DATA_DIR) + "/middlebury-v2"))
        return true;
    std::printf("NOT RUN: %s needs the pictures of DICOT_DATA_DIR, and %s is not there\n", test, DICOT_DATA_DIR);
    return false;
}

std::vector<Scene> middlebury_v2()
{
    return {scene("middlebury-v2", "tsukuba", 16, 16), scene("middlebury-v2", "venus", 20, 8),
            scene("middlebury-v2", "teddy", 60, 4), scene("middlebury-v2", "cones", 60, 4)};
}

Scene aloe_third()
{
    return scene("plants", "aloe-third", 80, 3);
}

Picture read(const std::string& path)
{
    const Result<PictureSize> size = picture_size(path.c_str());
    if (!size.ok())
        stop(size.status());
    Picture picture{size.value().width, size.value().height, {}};
    picture.pixels.resize(static_cast<std::size_t>(size.value().pixels()));
    const Status status = read_picture(path.c_str(), picture.view());
    if (!status.ok())
        stop(status);
    return picture;
}

ErrorRates error_rates(const Scene& scene, const DisparityMap& map, double threshold_px)
{
    const auto rate = [&](const std::vector<bool>& mask) {
        int counted = 0;
        int wrong = 0;
        for (int y = 0; y < scene.left.height; ++y) {
            for (int x = 0; x < scene.left.width; ++x) {
                const auto i = static_cast<std::size_t>(y * scene.left.width + x);
                if (!mask[i])
                    continue;
                ++counted;
                const DispQ8 value = map.relative.row(y)[x];
                const double d = map.min_disparity + value / 256.0;
                wrong += value == kDispMissing || !(std::abs(d - scene.truth[i]) <= threshold_px);
            }
        }
        return 100.0 * wrong / counted;
    };
    return {rate(scene.nonocc), rate(scene.all), rate(scene.disc)};
}

} // namespace dicot::scenes
