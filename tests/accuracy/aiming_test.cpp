// What the comparison of two views says of every real and rendered pair, also swapped, and how long it takes.
#include "lent_arena.h"

#include "dicot/aiming/views.h"
#include "dicot/calibration/grey.h"
#include "dicot/os/clock.h"
#include "dicot/picture/read_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace dicot::aiming {
namespace {

namespace fs = std::filesystem;

struct Grey
{
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;

    explicit Grey(const fs::path& file)
    {
        const PictureSize size = picture_size(file.c_str()).value();
        width = size.width;
        height = size.height;
        std::vector<Rgb8> colours(static_cast<std::size_t>(size.pixels()));
        pixels.resize(colours.size());
        const ImageView<Rgb8> colour{colours.data(), width, height};
        EXPECT_TRUE(read_picture(file.c_str(), colour).ok()) << file;
        calibration::to_grey(colour, {pixels.data(), width, height});
    }
    ImageView<const std::uint8_t> view() const { return {pixels.data(), width, height}; }
};

/// Every file whose name begins with or ends in "left" and has a twin named "right", sorted.
std::vector<fs::path> lefts_below(const fs::path& folder)
{
    std::vector<fs::path> lefts;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        const bool picture = name.find("left") != std::string::npos && name.find("gt_") == std::string::npos &&
                             name.find("disp") == std::string::npos && !entry.path().extension().empty() &&
                             entry.path().extension() != ".yml";
        if (picture)
            lefts.push_back(entry.path());
    }
    std::ranges::sort(lefts);
    return lefts;
}

fs::path right_of(const fs::path& left)
{
    std::string name = left.filename().string();
    name.replace(name.find("left"), 4, "right");
    return left.parent_path() / name;
}

struct Counts
{
    int pairs = 0, as_named = 0, not_known = 0, swapped = 0;

    void add(Order order)
    {
        ++pairs;
        ++(order == Order::kAsNamed ? as_named : order == Order::kSwapped ? swapped : not_known);
    }
    void print(const char* what) const
    {
        std::printf("%-24s %3d pairs | as named %3d | not known %3d | swapped %3d\n", what, pairs, as_named, not_known,
                    swapped);
    }
};

Views compare(const Grey& left, const Grey& right)
{
    test::LentArena scratch(view_scratch_bytes(left.width, left.height));
    return compare_views(left.view(), right.view(), scratch.arena()).value();
}

bool present(const char* test, const fs::path& folder)
{
    if (fs::exists(folder))
        return true;
    std::printf("NOT RUN: %s: %s is not there\n", test, folder.c_str());
    return false;
}

struct Verdicts
{
    Counts forward, backward;
};

Verdicts verdicts(const fs::path& folder)
{
    Verdicts all;
    for (const fs::path& file : lefts_below(folder)) {
        if (!fs::exists(right_of(file)))
            continue;
        const Grey left(file), right(right_of(file));
        const Views views = compare(left, right);
        all.forward.add(views.order);
        EXPECT_NE(views.order, Order::kSwapped) << file;
        const Views swapped = compare(right, left);
        all.backward.add(swapped.order);
        EXPECT_NE(swapped.order, Order::kAsNamed) << file;
    }
    all.forward.print(folder.filename().c_str());
    all.backward.print("  swapped by hand");
    return all;
}

TEST(Aiming, SwappedPairsAreNamedAndNoOtherIs)
{
    const fs::path data{DICOT_DATA_DIR};
    if (!present("Aiming.SwappedPairsAreNamedAndNoOtherIs", data / "rig-dev"))
        return;
    int pairs = 0, known = 0, named_swapped = 0;
    for (const char* set : {"middlebury-v2", "plants", "rig-dev/plants", "rig-dev/growth", "rig-dev/box",
                            "rig-dev/box_slanted", "calibration-opencv"}) {
        const Verdicts seen = verdicts(data / set);
        pairs += seen.forward.pairs;
        known += seen.forward.as_named;
        named_swapped += seen.backward.swapped;
    }
    EXPECT_GE(pairs, 60);
    EXPECT_GE(known * 100, pairs * 90);
    EXPECT_GE(named_swapped * 100, pairs * 90);
    verdicts(data / "rig-dev/calibration"); // boards before a far wall: mostly not known, never wrong
}

/// As a dim lamp and a noisy sensor leave it.
void darken(Grey& grey, unsigned seed)
{
    std::mt19937 random{seed};
    for (std::uint8_t& pixel : grey.pixels)
        pixel = static_cast<std::uint8_t>(pixel / 16 + random() % 7);
}

/// Three means over 5 x 1, then over 1 x 5 pixels: a sigma of about 2.4 px.
void blur(Grey& grey)
{
    for (int pass = 0; pass < 6; ++pass) {
        const int step = pass < 3 ? 1 : grey.width;
        std::vector<std::uint8_t> mean = grey.pixels;
        for (std::size_t i = 2 * static_cast<std::size_t>(step); i + 2 * static_cast<std::size_t>(step) < mean.size();
             ++i) {
            int sum = 0;
            for (int k = -2; k <= 2; ++k)
                sum += grey.pixels[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + k * step)];
            mean[i] = static_cast<std::uint8_t>((sum + 2) / 5);
        }
        grey.pixels = std::move(mean);
    }
}

TEST(Aiming, NoWorsePictureIsTakenForTheWrongOrder)
{
    const fs::path data{DICOT_DATA_DIR};
    if (!present("Aiming.NoWorsePictureIsTakenForTheWrongOrder", data / "rig-dev"))
        return;
    Counts dark, blurred, same;
    for (const char* set : {"middlebury-v2", "rig-dev/plants", "rig-dev/box", "calibration-opencv"})
        for (const fs::path& file : lefts_below(data / set)) {
            if (!fs::exists(right_of(file)))
                continue;
            Grey left(file), right(right_of(file));
            same.add(compare(left, left).order);
            Grey dim_left = left, dim_right = right;
            darken(dim_left, 1);
            darken(dim_right, 2);
            dark.add(compare(dim_left, dim_right).order);
            EXPECT_NE(compare(dim_right, dim_left).order, Order::kAsNamed) << file;
            blur(left);
            blur(right);
            blurred.add(compare(left, right).order);
            EXPECT_NE(compare(right, left).order, Order::kAsNamed) << file;
        }
    dark.print("dark and noisy");
    blurred.print("blurred");
    same.print("left twice");
    EXPECT_EQ(dark.swapped + blurred.swapped, 0);
    EXPECT_EQ(same.not_known, same.pairs);
    EXPECT_GE(blurred.as_named * 100, blurred.pairs * 85);
}

TEST(Aiming, TheRenderedRigsRollIsMeasured)
{
    const fs::path plants = fs::path{DICOT_DATA_DIR} / "rig-dev/plants";
    if (!present("Aiming.TheRenderedRigsRollIsMeasured", plants))
        return;
    constexpr double kTruth = 1.068; // its README: -1.068 degrees about z from left to right
    for (const fs::path& file : lefts_below(plants)) {
        const Views views = compare(Grey(file), Grey(right_of(file)));
        EXPECT_NEAR(views.roll_deg, kTruth, 0.4) << file << ", " << views.matches << " matches";
    }
}

TEST(Aiming, TimeIsPrinted)
{
    const fs::path data{DICOT_DATA_DIR};
    if (!present("Aiming.TimeIsPrinted", data / "rig-dev"))
        return;
    for (const char* file : {"calibration-opencv/left01.jpg", "rig-dev/plants/p1_epipremnum/overcast_left.jpg"}) {
        const Grey left(data / file), right(right_of(data / file));
        std::vector<double> ms;
        for (int round = 0; round < 15; ++round) {
            const std::int64_t start = process_cpu_us();
            EXPECT_TRUE(compare(left, right).known());
            ms.push_back(static_cast<double>(process_cpu_us() - start) * 1e-3);
        }
        std::ranges::sort(ms);
        std::printf("compare_views %4d x %3d: best %.1f ms, median %.1f ms of processor time\n", left.width,
                    left.height, ms.front(), ms[ms.size() / 2]);
    }
}

} // namespace
} // namespace dicot::aiming
