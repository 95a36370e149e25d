// The report of a calibration: a page that opens anywhere, says what the run says, and survives what it is given.
#include "calibrate/report.h"
#include "calibrate/report_measures.h"
#include "calibrate/report_pictures.h"
#include "calibrate/report_text.h"

#include "rig_scene.h"
#include "temp_folder.h"
#include "tool.h"

#include "dicot/picture/read_picture.h"
#include "dicot/picture/write_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace dicot::app {
namespace {

using test::Bytes;
using test::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const calibration::Board kBoard{7, 5, 40};
constexpr const char* kHostile = "<script>&\"'.jpg";

StereoRig small_rig()
{
    StereoRig rig;
    rig.width = 400;
    rig.height = 300;
    rig.left = rig.right = {390, 391, 201, 148, {}};
    rig.turn = test::turn_about(-0.8, 0.5, 0.6);
    rig.shift_mm = {-80, 0.7, 1.1};
    return rig;
}

std::string printed(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string printed(const char* format, ...)
{
    std::array<char, 300> text{};
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text.data(), text.size(), format, arguments);
    va_end(arguments);
    return text.data();
}

void write_photo(const std::string& path, const test::Photo& photo)
{
    std::vector<Rgb8> pixels;
    for (const std::uint8_t grey : photo.pixels)
        pixels.push_back({grey, grey, grey});
    ASSERT_TRUE(write_png(path.c_str(), ImageView<const Rgb8>{pixels.data(), photo.width, photo.height}).ok());
}

void set_camera(RigCamera& camera, const Lens& lens)
{
    camera.intrinsic = {{{lens.fx, 0, lens.cx}, {0, lens.fy, lens.cy}, {0, 0, 1}}};
    Distortion distortion;
    distortion.count = 5;
    std::copy_n(lens.k.begin(), 5, distortion.at.begin());
    camera.distortion = distortion;
}

/// Photographs six boards, finds them and calibrates; the sixth is not in the right picture, and has a hostile name.
void photograph_run(const std::string& folder, CalibrationRun& run)
{
    const StereoRig rig = small_rig();
    const std::array<test::Placement, 6> places{{{test::turn_about(25, 0, 2), {-40, -10, 560}},
                                                 {test::turn_about(-25, 10, -4), {60, 20, 640}},
                                                 {test::turn_about(0, 30, 3), {20, -20, 600}},
                                                 {test::turn_about(5, -30, 0), {50, 10, 700}},
                                                 {test::turn_about(-20, -20, 8), {0, 20, 950}},
                                                 {test::turn_about(10, 10, 0), {20, 0, 620}}}};
    run.task.boards = {kBoard};
    run.task.width = rig.width;
    run.task.height = rig.height;
    for (std::size_t k = 0; k < places.size(); ++k) {
        SeenPair pair;
        const bool last = k + 1 == places.size();
        pair.name = last ? kHostile : "left" + std::to_string(k) + ".png and right" + std::to_string(k) + ".png";
        pair.left_path = folder + "/left" + std::to_string(k) + ".png";
        pair.right_path = folder + "/right" + std::to_string(k) + ".png";
        test::Scene scene{kBoard, places[k], rig.left, rig.width, rig.height};
        scene.seed = static_cast<std::uint32_t>(k + 1);
        const test::Photo left = test::photograph(scene);
        scene.lens = rig.right;
        scene.place = test::in_right(rig, places[k]);
        if (last)
            scene.place.shift_mm.x += 5000;
        const test::Photo right = test::photograph(scene);
        write_photo(pair.left_path, left);
        write_photo(pair.right_path, right);
        pair.left = calibration::find_board(left.view(), kBoard);
        pair.right = calibration::find_board(right.view(), kBoard);
        ASSERT_TRUE(pair.left.found) << k << ": " << pair.left.reason;
        ASSERT_EQ(pair.right.found, !last) << k << ": " << pair.right.reason;
        pair.board = 0;
        if (last) {
            pair.rejected = "right: <none> & nothing";
        } else {
            ASSERT_TRUE(calibration::agree_on_order(kBoard, pair.left, pair.right).ok());
            pair.view = static_cast<int>(run.task.views.size());
            run.task.views.push_back({0, pair.left.corners, pair.right.corners});
        }
        run.pairs.push_back(std::move(pair));
    }
    auto solved = calibration::solve_stereo(run.task);
    ASSERT_TRUE(solved.ok()) << solved.status().message();
    run.calibration = std::move(solved).value();
    run.quality = calibration::assess(run.task, run.calibration, run.range);
    const StereoRig& found = run.calibration.rig;
    run.rig.width = found.width;
    run.rig.height = found.height;
    set_camera(run.rig.left, found.left);
    set_camera(run.rig.right, found.right);
    const Turn& t = found.turn;
    run.rig.rotation = {{{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}}};
    run.rig.translation_mm = {found.shift_mm.x, found.shift_mm.y, found.shift_mm.z};
    std::snprintf(run.rig.id, sizeof run.rig.id, "sha256:0123abcd");
    std::snprintf(run.rig.calibrated_at, sizeof run.rig.calibrated_at, "2026-03-01T12:00:00Z");
}

/// One run for all tests: photographing takes a second.
class Report : public ::testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        photos_ = std::make_unique<TempFolder>();
        run_ = std::make_unique<CalibrationRun>();
        photograph_run(photos_->path("."), *run_);
    }
    static void TearDownTestSuite()
    {
        run_.reset();
        photos_.reset();
    }
    static const CalibrationRun& run() { return *run_; }
    static std::string page_of(const std::string& folder)
    {
        const Bytes bytes = test::bytes_of(folder + "/index.html");
        return {bytes.begin(), bytes.end()};
    }

    /// Parses the page as XML and runs Python over it: `body` sees `root` and prints.
    static std::string ask(const TempFolder& folder, const std::string& report, const std::string& body)
    {
        const std::string script = folder.write("ask.py", "import sys\n"
                                                          "import xml.etree.ElementTree as tree\n"
                                                          "root = tree.parse(sys.argv[1]).getroot()\n" +
                                                              body);
        const test::ToolRun asked =
            test::run("PYTHONIOENCODING=utf-8 python3 " + script + " " + report + "/index.html");
        EXPECT_EQ(asked.exit_code, 0) << asked.output;
        return asked.output;
    }

private:
    static inline std::unique_ptr<TempFolder> photos_;
    static inline std::unique_ptr<CalibrationRun> run_;
};

TEST_F(Report, IsXmlNeedsNoNetworkAndLinksToFilesThatAreThere)
{
    DICOT_NEED_TOOL("python3", "python3");
    const TempFolder folder;
    const std::string report = folder.path("report");
    const Status written = write_report(run(), report);
    ASSERT_TRUE(written.ok()) << written.message();
    const std::string page = page_of(report);
    for (const char* reach : {"http:", "https:", "file:", "data:", "//", "<script", "@import", "src="})
        EXPECT_THAT(page, Not(HasSubstr(reach)));

    const std::string links = ask(folder, report,
                                  "ids = {e.get('id') for e in root.iter()}\n"
                                  "for e in root.iter():\n"
                                  "    link = e.get('href')\n"
                                  "    if link is None: continue\n"
                                  "    if link[0] == '#': assert link[1:] in ids, link\n"
                                  "    else: print(link)\n");
    std::size_t files = 0;
    for (std::size_t at = 0, end = 0; (end = links.find('\n', at)) != std::string::npos; at = end + 1, ++files) {
        const std::string file = report + "/" + links.substr(at, end - at);
        EXPECT_TRUE(picture_size(file.c_str()).ok()) << file;
    }
    EXPECT_EQ(files, 2 * run().pairs.size() + 2) << "two for each pair and the rectified ones";
}

TEST_F(Report, ShowsHostileNamesAsText)
{
    DICOT_NEED_TOOL("python3", "python3");
    const TempFolder folder;
    const std::string report = folder.path("report");
    ASSERT_TRUE(write_report(run(), report).ok());
    const std::string text = ask(folder, report,
                                 "assert not [e for e in root.iter() if e.tag in ('script', 'none')]\n"
                                 "last = [e for e in root.iter() if e.get('id') == 'pair-6'][0]\n"
                                 "print('\\n'.join(last.itertext()))\n");
    EXPECT_THAT(text, HasSubstr(kHostile));
    EXPECT_THAT(text, HasSubstr("right: <none> & nothing"));
    EXPECT_THAT(text, HasSubstr("not used"));
}

TEST_F(Report, TellsTheNumbersOfTheRun)
{
    DICOT_NEED_TOOL("python3", "python3");
    const TempFolder folder;
    const std::string report = folder.path("report");
    ASSERT_TRUE(write_report(run(), report).ok());
    const std::string rows = ask(folder, report,
                                 "for r in root.iter('tr'): print('|'.join(''.join(c.itertext()) for c in r))\n"
                                 "for t in root.iter('b'): print('tile|' + ''.join(t.itertext()))\n"
                                 "print('verdict|' + ''.join(next(root.iter('h1')).itertext()).lower())\n"
                                 "for e in root.iter('li'): print('advice|' + ''.join(e.itertext()).lower())\n");
    const calibration::Quality& q = run().quality;
    const calibration::StereoCalibration& c = run().calibration;
    EXPECT_THAT(rows, HasSubstr(printed("\nRMS|%.3f px|", c.rms_px)));
    EXPECT_THAT(rows, HasSubstr(printed("\nCorner noise|%.3f px|", c.sigma_px)));
    EXPECT_THAT(rows, HasSubstr(printed("\nEpipolar RMS|%.3f px|", q.epipolar_rms_px)));
    EXPECT_THAT(rows, HasSubstr(printed("\nEpipolar 95 %%|%.3f px|", q.epipolar_p95_px)));
    EXPECT_THAT(rows, HasSubstr(printed("Held-out shape|%.2f mm|Boards of %d pairs", q.held_out_mm, q.held_out_pairs)));
    EXPECT_THAT(rows, HasSubstr(printed("\nHeld-out depth|%.2f mm|", q.held_out_depth_mm)));
    EXPECT_THAT(rows, HasSubstr(printed("\nBaseline|%.3f ± ", c.rig.baseline_mm())));
    EXPECT_THAT(rows, HasSubstr("\nPairs|5 of 6|"));
    EXPECT_THAT(rows, HasSubstr("\nPictures|400 x 300 px|"));
    EXPECT_THAT(rows, HasSubstr("\nDate|2026-03-01T12:00:00Z|"));
    EXPECT_THAT(rows, HasSubstr("\nCalibration|sha256:0123abcd|"));
    EXPECT_THAT(rows, HasSubstr(printed("\nfx, px|%.2f ± %.2f|%.2f ± %.2f\n", c.rig.left.fx, c.deviation(0),
                                        c.rig.right.fx, c.deviation(9))));
    EXPECT_THAT(rows, HasSubstr(printed("\nk1|%.5f ± %.5f|%.5f ± %.5f\n", c.rig.left.k[0], c.deviation(4),
                                        c.rig.right.k[0], c.deviation(13))));
    EXPECT_THAT(rows, HasSubstr("\nk3|0.00000|0.00000\n"));
    EXPECT_THAT(rows, HasSubstr(printed("\nT x, mm|%.3f ± %.3f\n", c.rig.shift_mm.x, c.deviation(21))));
    for (const calibration::DepthError& depth : q.depth)
        EXPECT_THAT(rows, HasSubstr(printed("tile|± %.2f mm\n", depth.calibration_mm)));
    EXPECT_THAT(rows, HasSubstr(printed("verdict|%s\n", calibration::name_of(q.verdict))));
    ASSERT_FALSE(q.advice.empty()); // five pairs are few
    for (const std::string& advice : q.advice)
        EXPECT_THAT(rows, HasSubstr(printed("advice|%s", advice.c_str())));
}

TEST_F(Report, TheSameRunGivesTheSameBytes)
{
    const TempFolder folder;
    const std::string first = folder.path("first"), second = folder.path("second");
    ASSERT_TRUE(write_report(run(), first).ok());
    ASSERT_TRUE(write_report(run(), second).ok());
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(first)) {
        const std::string name = entry.path().filename().string();
        EXPECT_EQ(test::bytes_of(first + "/" + name), test::bytes_of(second + "/" + name)) << name;
        ++files;
    }
    EXPECT_EQ(files, 15);
}

TEST_F(Report, NotesAPictureThatIsGone)
{
    DICOT_NEED_TOOL("python3", "python3");
    const TempFolder folder;
    CalibrationRun poorer = run();
    for (SeenPair& pair : poorer.pairs)
        pair.left_path = folder.path("<gone>.png");
    const std::string report = folder.path("report");
    const Status written = write_report(poorer, report);
    ASSERT_TRUE(written.ok()) << written.message();
    const std::string lost =
        ask(folder, report, "print([e for e in root.iter('p') if e.get('class') == 'lost'].__len__())\n");
    EXPECT_EQ(lost, "6\n");
    EXPECT_FALSE(std::filesystem::exists(report + "/rectified-left.jpg"));
    EXPECT_THAT(page_of(report), HasSubstr("No picture here: "));
}

TEST_F(Report, ShowsThePairsOfARunThatWasRefused)
{
    DICOT_NEED_TOOL("python3", "python3");
    const TempFolder folder;
    CalibrationRun refused = run();
    refused.calibration = {};
    refused.quality = {};
    refused.quality.advice = {"all views are alike: <tilt> the board"};
    const std::string report = folder.path("report");
    ASSERT_TRUE(write_report(refused, report).ok());
    const std::string text = ask(folder, report, "print(' '.join(root.itertext()))\n");
    EXPECT_THAT(text, HasSubstr("Redo"));
    EXPECT_THAT(text, HasSubstr("All views are alike: <tilt> the board."));
    EXPECT_THAT(text, HasSubstr("left0.png and right0.png"));
    EXPECT_THAT(text, Not(HasSubstr("Held-out")));
}

TEST_F(Report, AFolderThatCannotBeMadeIsNamed)
{
    const TempFolder folder;
    const std::string file = folder.write("taken", std::string("mine"));
    const Status status = write_report(run(), file);
    EXPECT_EQ(status.fault(), Fault::kCannotCreate);
    EXPECT_THAT(status.message(), HasSubstr(file));
    EXPECT_EQ(test::bytes_of(file), (Bytes{'m', 'i', 'n', 'e'}));
}

TEST_F(Report, AFailureLeavesNoPageOfAnEarlierRun)
{
    const TempFolder folder;
    const std::string report = folder.path("report");
    ASSERT_TRUE(write_report(run(), report).ok());
    std::filesystem::remove(report + "/pair-3-left.jpg");
    std::filesystem::create_directory(report + "/pair-3-left.jpg");
    EXPECT_EQ(write_report(run(), report).fault(), Fault::kCannotCreate);
    EXPECT_FALSE(std::filesystem::exists(report + "/index.html"));
}

double rms_of(const std::vector<CornerMiss>& misses)
{
    double squares = 0;
    for (const CornerMiss& m : misses)
        squares += m.miss.x * m.miss.x + m.miss.y * m.miss.y;
    return std::sqrt(squares / static_cast<double>(misses.size()));
}

TEST(ReportMeasures, MissesAreTheResidualsOfTheSolution)
{
    for (const bool warp : {false, true}) {
        CalibrationRun run;
        run.task = test::varied_task(test::webcam_rig(), {9, 7, 35}, 12, 0.1, 7);
        run.task.fit_warp = warp;
        run.task.views[2].right.clear(); // helps the left lens alone
        run.calibration = calibration::solve_stereo(run.task).value();
        EXPECT_EQ(run.calibration.warp_mm[0] != 0, warp);
        EXPECT_NEAR(rms_of(corner_misses(run, Eye::kLeft)), run.calibration.rms_left_px, 1e-9) << warp;
        EXPECT_NEAR(rms_of(corner_misses(run, Eye::kRight)), run.calibration.rms_right_px, 1e-9) << warp;
        EXPECT_EQ(corner_misses(run, Eye::kLeft).size(), 12U * 63);
        EXPECT_EQ(corner_misses(run, Eye::kRight).size(), 11U * 63);
    }
}

TEST(ReportMeasures, RowsOfTheTrueRigAgreeAndAShiftIsMeasured)
{
    CalibrationRun run;
    const StereoRig truth = test::webcam_rig();
    run.task = test::varied_task(truth, {9, 7, 35}, 6, 0, 3);
    run.calibration.rig = truth;
    run.calibration.views.resize(6);
    for (calibration::ViewOutcome& view : run.calibration.views)
        view.used = true;
    const Rectification flat = rectify(truth, kCrop, "truth").value();
    const RowGaps exact = row_gaps(run, flat);
    ASSERT_EQ(exact.gaps_px.size(), 6U * 63);
    EXPECT_LT(exact.most_px, 1e-6);

    for (calibration::View& view : run.task.views)
        for (Point2& p : view.right)
            p.y += 0.5;
    const RowGaps shifted = row_gaps(run, flat);
    const double expected = 0.5 * flat.focal_px / truth.right.fy; // as far as distortion and turn let it
    EXPECT_NEAR(shifted.rms_px, expected, 0.05 * expected);
    EXPECT_LT(shifted.gaps_px.front(), 0) << "left row minus right row";
    EXPECT_GE(shifted.most_px, shifted.p95_px);
    EXPECT_GE(shifted.p95_px, shifted.rms_px * 0.9);
}

TEST(ReportMeasures, NamesTheEmptyPartsOfAPicture)
{
    calibration::Coverage coverage;
    coverage.corners.fill(3);
    EXPECT_TRUE(empty_parts(coverage).empty());
    for (const std::size_t cell :
         {0U, 1U, 8U, 9U, 43U, 44U, 35U, 36U}) // 4 of 6 at the upper left, all below the middle
        coverage.corners[cell] = 0;
    EXPECT_THAT(empty_parts(coverage), ElementsAre("upper left", "lower middle"));
}

TEST(ReportPictures, ShrinkingKeepsTheMeanOfWhatAPixelCovers)
{
    const TempFolder folder;
    constexpr int kWidth = 1201, kHeight = 331; // no multiple of the small size
    std::vector<Rgb8> pixels;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto grey = static_cast<std::uint8_t>((x % 2 == 0 ? 60 : 0) + x * 180 / kWidth);
            pixels.push_back({grey, grey, grey});
        }
    SeenPair pair;
    pair.left_path = pair.right_path = folder.path("big.png");
    ASSERT_TRUE(write_png(pair.left_path.c_str(), ImageView<const Rgb8>{pixels.data(), kWidth, kHeight}).ok());
    const PairPictures small = write_thumbnails(pair, 1, folder.path(".")).value();
    EXPECT_EQ(small.left.width, kThumbnailWidth);
    EXPECT_EQ(small.left.height, 132); // 331 * 480 / 1201 = 132.3
    std::vector<Rgb8> seen(static_cast<std::size_t>(small.left.width) * static_cast<std::size_t>(small.left.height));
    ASSERT_TRUE(read_picture(folder.path(small.left.file).c_str(),
                             ImageView<Rgb8>{seen.data(), small.left.width, small.left.height})
                    .ok());
    for (std::size_t k = 0; k < seen.size(); ++k) {
        const double x = static_cast<double>(k % kThumbnailWidth) + 0.5;
        // 2.5 stripes to a pixel, 1 to 1.5 of them bright: 24 to 36; the rest is JPEG's.
        ASSERT_NEAR(seen[k].g, 30 + x * 180 / kThumbnailWidth, 6 + 4) << k;
    }
}

TEST(ReportText, EscapesWhatMarkupAndXmlCannotHold)
{
    EXPECT_EQ(escaped("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
    EXPECT_EQ(escaped("Bl\xC3\xA4tter \xF0\x9F\x8C\xB1"), "Bl\xC3\xA4tter \xF0\x9F\x8C\xB1");
    const std::string no = "\xEF\xBF\xBD";
    EXPECT_EQ(escaped("\x01\x7F"), no + no);
    EXPECT_EQ(escaped("a\n\tb"), "a  b");
    EXPECT_EQ(escaped("\xFF<"), no + "&lt;");
    EXPECT_EQ(escaped("\xC3<"), no + "&lt;") << "a cut sequence must not swallow the bracket";
    EXPECT_EQ(escaped("\xC0\xBC"), no + no) << "an overlong <";
    EXPECT_EQ(escaped("\xED\xA0\x80"), no + no + no) << "a surrogate";
    EXPECT_EQ(escaped("\xEF\xBF\xBF"), no + no + no) << "U+FFFF";
    EXPECT_EQ(escaped("\xF4\x90\x80\x80"), no + no + no + no) << "beyond U+10FFFF";
}

TEST(ReportText, FixesDecimals)
{
    EXPECT_EQ(fixed(-0.004, 2), "0.00");
    EXPECT_EQ(fixed(-0.006, 2), "-0.01");
    EXPECT_EQ(fixed(1234.5678, 1), "1234.6");
    EXPECT_EQ(fixed(std::nan(""), 2), "unknown");
    EXPECT_EQ(fixed(-1e300, 2), "unknown");
    EXPECT_EQ(fill("{} of {}", {3, std::string("{}")}), "3 of {}");
}

} // namespace
} // namespace dicot::app
