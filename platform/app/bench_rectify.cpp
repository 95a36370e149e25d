#include "bench_rectify.h"

#include "rectify_rig.h"
#include "take_picture.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <array>

namespace dicot::app {
namespace {

/// Two webcams 85 mm apart that squint by a degree, with the distortion that webcams have.
RigFile webcams()
{
    RigFile rig;
    rig.width = RectifySpeed::kWidth;
    rig.height = RectifySpeed::kHeight;
    rig.left.intrinsic = {{{780, 0, 641}, {0, 782, 355}, {0, 0, 1}}};
    rig.left.distortion = Distortion{5, {-0.11, 0.045, 0.0008, -0.0009, 0}};
    rig.right.intrinsic = {{{786, 0, 634}, {0, 785, 364}, {0, 0, 1}}};
    rig.right.distortion = Distortion{5, {-0.13, 0.030, -0.0006, 0.0011, 0}};
    // By 1 degree about the vertical: the cosine of it and its sine.
    constexpr double kCosine = 0.99984769515639124, kSine = 0.017452406437283512;
    rig.rotation = {{{kCosine, 0, kSine}, {0, 1, 0}, {-kSine, 0, kCosine}}};
    rig.translation_mm = {-85, 1, 1.5};
    return rig;
}

} // namespace

Result<RectifySpeed> time_rectify(const Kernels& kernels)
{
    constexpr int kWidth = RectifySpeed::kWidth, kHeight = RectifySpeed::kHeight;
    RigFile rig = webcams();
    const RectifyTables tables = TRY(RectifyTables::build(rig, kCrop, "bench"));
    const auto lay_out = [](Arena& arena) {
        std::array<ImageView<Rgb8>, 4> pictures;
        for (ImageView<Rgb8>& picture : pictures)
            picture = take_picture<Rgb8>(arena, kWidth, kHeight);
        return pictures;
    };
    Arena measure;
    (void)lay_out(measure);
    const MemoryBlock block = TRY(MemoryBlock::map(measure.peak(), Pages::kResident));
    Arena arena(block.bytes());
    const auto [left, right, flat_left, flat_right] = lay_out(arena);
    // What the pixels say does not matter: no path depends on them.
    std::array<double, RectifySpeed::kRounds + 1> ms{};
    for (double& round : ms) {
        const std::int64_t start_us = process_cpu_us();
        remap(tables.left(), kernels, left, flat_left, tables.spans());
        remap(tables.right(), kernels, right, flat_right, tables.spans());
        round = static_cast<double>(process_cpu_us() - start_us) * 1e-3;
    }
    std::ranges::sort(ms.begin() + 1, ms.end());
    return RectifySpeed{ms[1 + RectifySpeed::kRounds / 2]};
}

} // namespace dicot::app
