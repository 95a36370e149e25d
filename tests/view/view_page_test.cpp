// The page of dicot view in a real browser: what page.mjs promises, on a store and a cloud that are made here.
#include "archive_folder.h"
#include "drawn_plant.h"
#include "store_commands.h"

#include "dicot/codec/encode_cloud.h"

#include <cmath>
#include <fstream>
#include <vector>

namespace dicot {
namespace {

namespace fs = std::filesystem;

/// A camera of 160 x 120 px, focal length 200 px, before a grey wall 600 mm away. Around pixel (40, 60) there is red at
/// 500 mm, around (120, 70) blue at 700 mm: (-100, 0, 500) and (140, 35, 700) mm, 314.36 mm apart.
std::vector<CloudPoint> known_points()
{
    constexpr int kWidth = 160, kHeight = 120, kPatch = 2;
    constexpr double kFocalPx = 200, kCx = 80, kCy = 60, kStepsPerMm = 10;
    std::vector<CloudPoint> points;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool red = std::abs(x - 40) <= kPatch && std::abs(y - 60) <= kPatch;
            const bool blue = std::abs(x - 120) <= kPatch && std::abs(y - 70) <= kPatch;
            const double z = (red ? 500 : blue ? 700 : 600) * kStepsPerMm;
            const Rgb8 colour = red ? Rgb8{255, 0, 0} : blue ? Rgb8{0, 0, 255} : Rgb8{120, 120, 120};
            points.push_back({static_cast<std::int32_t>(std::lround((x - kCx) / kFocalPx * z)),
                              static_cast<std::int32_t>(std::lround((y - kCy) / kFocalPx * z)),
                              static_cast<std::int32_t>(z), colour, static_cast<std::uint8_t>(2 * y)});
        }
    return points;
}

void write_known_cloud(const std::string& path)
{
    const std::vector<CloudPoint> points = known_points();
    const CloudGrid grid{100, 14, {-8000, -8000, 0}};
    CloudMeta meta;
    meta.sequence = 7;
    std::vector<std::byte> heap(encode_heap_bytes(points.size()));
    const Result<EncodedCloud> encoded = encode_cloud({points, grid}, meta, heap);
    ASSERT_TRUE(encoded.ok()) << encoded.status().message();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(encoded.value().bytes.data()),
               static_cast<std::streamsize>(encoded.value().bytes.size()));
}

/// One folder for all cases: store, known.drc, exported.
class ViewPage : public test::StoreOfOneBoard
{
protected:
    static void SetUpTestSuite()
    {
        if (not_run() != nullptr)
            return;
        test::StoreOfOneBoard::SetUpTestSuite();
        const std::string store = scene() + "/store";
        ASSERT_EQ(snap(folder_->path("first")).exit_code, 0);
        fs::create_directory(scene());
        fs::rename(folder_->path("first"), store);
        const fs::path damaged = snapshots(store).at(2) / "cloud.drc";
        fs::resize_file(damaged, fs::file_size(damaged) / 2);
        write_known_cloud(scene() + "/known.drc");
        test::write_plant(scene() + "/plant.drc", {.leaves = 4});
        test::ArchiveFolder beds(scene() + "/beds", "bench");
        for (const int day : {1, 2})
            beds.done(day, "2026-06-0" + std::to_string(day) + "T12:00:00Z", scene() + "/plant.drc");
        std::ofstream(scene() + "/beds.csv") << "name,min_x_mm,min_y_mm,min_z_mm,max_x_mm,max_y_mm,max_z_mm\n"
                                                "<i>basil</i>,,,,,,\nempty,-9000,-9000,,-8000,-8000,\n";
    }
    static void TearDownTestSuite() { test::StoreOfOneBoard::TearDownTestSuite(); }

    static std::string scene() { return folder_->path("scene"); }
    /// Null: it can run.
    static const char* not_run()
    {
        const std::string_view why = DICOT_NO_BROWSER;
        return why.empty() ? nullptr : DICOT_NO_BROWSER;
    }

    static void expect(const std::string& scenario)
    {
        if (not_run() != nullptr) {
            std::printf("NOT RUN: the page in a browser: %s\n", not_run());
            return;
        }
        const std::string command = "XDG_CACHE_HOME='" + folder_->path("cache") +
                                    "' DICOT_CHROMIUM='" DICOT_CHROMIUM "' '" DICOT_NODE "' '" DICOT_PAGE_TEST "' " +
                                    scenario + " '" DICOT_PROGRAM "' '" + scene() + "'";
        const test::ToolRun run = test::run(command);
        std::printf("%s", run.output.c_str());
        EXPECT_EQ(run.exit_code, 0);
    }
};

TEST_F(ViewPage, LoadsWithoutAnErrorAndDrawsTheCloudAndAsksNobodyElse)
{
    expect("loads");
}

TEST_F(ViewPage, EachWayOfColouringIsAnotherPicture)
{
    expect("colours");
}

TEST_F(ViewPage, MeasuresAKnownDistanceByMouseAndByKeyboard)
{
    expect("measures");
}

TEST_F(ViewPage, ADamagedCloudIsToldAndTheNextOneIsShown)
{
    expect("damaged");
}

TEST_F(ViewPage, EverythingIsReachedByKeyboard)
{
    expect("keyboard");
}

TEST_F(ViewPage, PlantsBearTheNamesOfTheirPlaces)
{
    expect("plants");
}

TEST_F(ViewPage, FitsAPhone)
{
    expect("phone");
}

TEST_F(ViewPage, AnExportedFolderIsShownFromItsFiles)
{
    if (not_run() == nullptr) {
        ASSERT_EQ(::setenv("XDG_CACHE_HOME", (scene() + "/cache").c_str(), 1), 0); // what is measured is kept there
        const test::ToolRun run = dicot("view '" + scene() + "/store' --export '" + scene() + "/exported'");
        ASSERT_EQ(run.exit_code, 0) << run.output;
    }
    expect("exported");
}

TEST_F(ViewPage, TenThousandSlotsAreAStripOfFewElements)
{
    expect("season");
}

} // namespace
} // namespace dicot
