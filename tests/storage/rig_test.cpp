#include "temp_folder.h"

#include "dicot/rig/rig_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace dicot {
namespace {

std::span<const std::byte> bytes_of(const std::string& text)
{
    return std::as_bytes(std::span{text.data(), text.size()});
}

Result<RigFile> parsed(const std::string& text)
{
    return parse_rig(bytes_of(text), "rig.yaml");
}

std::string matrix(const std::string& key, int rows, int cols, const std::string& data)
{
    return key + ": !!opencv-matrix\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(cols) +
           "\n   dt: d\n   data: [ " + data + " ]\n";
}

const std::string kHead = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n";
const std::string kP1 = matrix("P1", 3, 4, "500., 0., 320., 0., 0., 500., 240., 0., 0., 0., 1., 0.");
const std::string kP2 = matrix("P2", 3, 4, "500., 0., 330., -3.0e+04, 0., 500., 240., 0., 0., 0., 1., 0.");

TEST(RigFile, GeometryFollowsFromTheProjections)
{
    const RigFile rig = parsed(kHead + kP1 + kP2).value();
    const RigGeometry geometry = geometry_of(rig, "rig.yaml").value();
    EXPECT_EQ(geometry.width, 640);
    EXPECT_EQ(geometry.height, 480);
    EXPECT_EQ(geometry.focal_px, 500);
    EXPECT_EQ(geometry.cx_px, 320);
    EXPECT_EQ(geometry.cy_px, 240);
    EXPECT_EQ(geometry.disparity_offset_px, 10);
    EXPECT_EQ(geometry.baseline_mm, 60);
}

TEST(RigFile, MetresBecomeMillimetres)
{
    const std::string q = matrix("Q", 4, 4, "1,0,0,-320, 0,1,0,-240, 0,0,0,500, 0,0,16.,4.");
    const std::string text = kHead + "unit: m\n" + kP1 + matrix("P2", 3, 4, "500,0,320,-30, 0,500,240,0, 0,0,1,0") +
                             matrix("T", 3, 1, "-0.06, 0.001, 0.") + q;
    const RigFile rig = parsed(text).value();
    EXPECT_DOUBLE_EQ(geometry_of(rig, "rig.yaml").value().baseline_mm, 60);
    EXPECT_DOUBLE_EQ((*rig.translation_mm)[0], -60);
    EXPECT_DOUBLE_EQ((*rig.reprojection)[3][2], 0.016); // 1 / baseline
    EXPECT_DOUBLE_EQ((*rig.reprojection)[2][3], 500);
}

TEST(RigFile, SpellingsOfOpenCvsSamplesAreKnown)
{
    const std::string k = "500,0,320, 0,501,240, 0,0,1";
    const RigFile rig =
        parsed("%YAML:1.0\nimageSize: [ 640, 480 ]\n" + matrix("M1", 3, 3, k) + matrix("D1", 1, 5, "1,2,3,4,5") +
               matrix("M2", 3, 3, k) + matrix("D2", 8, 1, "1,2,3,4,5,6,7,8"))
            .value();
    EXPECT_EQ(rig.width, 640);
    EXPECT_EQ(rig.height, 480);
    EXPECT_EQ((*rig.left.intrinsic)[1][1], 501);
    EXPECT_EQ(rig.left.distortion->count, 5);
    EXPECT_EQ(rig.right.distortion->count, 8);
    EXPECT_EQ(rig.right.distortion->at[7], 8);
    EXPECT_EQ(parsed("image_Width: 640\nimage_Height: 480\n").value().height, 480);
    EXPECT_EQ(parsed("\xEF\xBB\xBF" + kHead).value().width, 640);
}

TEST(RigFile, OneCameraOfTheCalibrationSampleIsTheLeftOne)
{
    const RigFile rig = parsed("image_width: 640\nimage_height: 480\ncalibration_time: \"Sun Oct 11 17:02:00 2009\"\n" +
                               matrix("camera_matrix", 3, 3, "535.9,0,342.3, 0,535.9,235.6, 0,0,1") +
                               matrix("distortion_coefficients", 5, 1, "-0.27,-0.04,0.0018,-0.0003,0.24"))
                            .value();
    EXPECT_EQ((*rig.left.intrinsic)[1][2], 235.6);
    EXPECT_EQ(rig.left.distortion->count, 5);
    EXPECT_FALSE(rig.right.intrinsic || rig.right.distortion);
    EXPECT_STREQ(rig.calibrated_at, "") << "somebody's local words are no time";
}

TEST(RigFile, ARotationVectorStandsForR)
{
    // A quarter turn about z; then a general one, worked out by the exponential series of its matrix in 60 digits.
    const RigFile quarter = parsed(kHead + matrix("om", 3, 1, "0, 0, 1.5707963267948966")).value();
    EXPECT_NEAR((*quarter.rotation)[0][1], -1, 1e-15);
    EXPECT_NEAR((*quarter.rotation)[1][0], 1, 1e-15);
    EXPECT_NEAR((*quarter.rotation)[0][0], 0, 1e-15);
    EXPECT_NEAR((*quarter.rotation)[2][2], 1, 1e-15);
    const RigFile general = parsed(kHead + matrix("om", 3, 1, "0.3, -2.5, 1.25")).value();
    const Matrix<3, 3> expected = {{{-0.92373368784692356, -0.32895831408626303, -0.19622054308926445},
                                    {-0.040398553980346273, 0.59309185034661871, -0.8041206463514794},
                                    {0.38089897712256909, -0.73486630392605945, -0.56114836236153542}}};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            EXPECT_NEAR((*general.rotation)[i][j], expected[i][j], 1e-14) << i << j;
}

TEST(RigFile, TimesAreSecondsThatExist)
{
    for (const char* time : {"2026-03-01T12:00:00Z", "2024-02-29T23:59:59Z", "1970-01-01T00:00:00Z"})
        EXPECT_STREQ(parsed(kHead + "calibration_time: " + time + "\n").value().calibrated_at, time);
    for (const char* time :
         {"2026-02-29T12:00:00Z", "2026-13-01T12:00:00Z", "2026-00-01T12:00:00Z", "2026-04-31T12:00:00Z",
          "2026-03-01T24:00:00Z", "2026-03-01T12:60:00Z", "2026-03-01 12:00:00", "2026-03-01T12:00:00+01:00"})
        EXPECT_NE(std::strstr(parsed(kHead + "calibration_time: " + time + "\n").status().message(),
                              "calibration_time must be a time in UTC"),
                  nullptr)
            << time;
}

TEST(RigFile, HintsFillWhatTheFileLeavesOpenAndMayNotContradictIt)
{
    const test::TempFolder folder;
    const std::string bare = folder.write("bare.yaml", "%YAML:1.0\n---\n" + matrix("T", 3, 1, "-2, 0, 0.5"));
    const RigFile rig = read_rig_file(bare.c_str(), {640, 480, 30}).value();
    EXPECT_EQ(rig.width, 640);
    EXPECT_EQ(rig.height, 480);
    EXPECT_EQ(*rig.translation_mm, (std::array<double, 3>{-60, 0, 15}));
    EXPECT_NE(std::strstr(read_rig_file(bare.c_str()).status().message(), "--size"), nullptr);
    const std::string whole = folder.write("whole.yaml", kHead + "unit: m\n");
    EXPECT_TRUE(read_rig_file(whole.c_str(), {640, 480, 1000}).ok());
    EXPECT_NE(std::strstr(read_rig_file(whole.c_str(), {320, 240, 0}).status().message(), "320 x 240"), nullptr);
    EXPECT_NE(std::strstr(read_rig_file(whole.c_str(), {0, 0, 1}).status().message(), "unit has 1000 mm"), nullptr);
}

TEST(RigFile, FilesOfTheRenderedRigAreRead)
{
    const std::string path = std::string{DICOT_DATA_DIR} + "/rig-dev/growth/gt_calib.yml";
    if (FILE* file = std::fopen(path.c_str(), "rb"); file != nullptr) {
        std::fclose(file);
    } else {
        std::printf("NOT RUN: %s is not there\n", path.c_str());
        return;
    }
    const RigFile rig = read_rig_file(path.c_str()).value();
    EXPECT_EQ(rig.width, 1280);
    EXPECT_NEAR((*rig.translation_mm)[0], -84.985, 0.001);
    EXPECT_NEAR((*rig.left.intrinsic)[0][0], 777.893, 0.001);
    EXPECT_EQ(rig.left.distortion->count, 5);
    const Result<RigGeometry> unrectified = geometry_of(rig, path.c_str());
    ASSERT_FALSE(unrectified.ok());
    EXPECT_NE(std::strstr(unrectified.status().message(), "P1 is missing"), nullptr);
}

TEST(RigFile, WhatIsWrittenIsReadAgainToTheLastBit)
{
    RigFile rig;
    std::strcpy(rig.id, "greenhouse-1_2024.05:a+b");
    rig.width = 1280;
    rig.height = 720;
    double number = 1.0 / 3;
    const auto fill = [&number](auto& matrix_to_fill) {
        for (auto& row : matrix_to_fill.emplace())
            for (double& value : row)
                value = number *= -1.7320508075688772;
    };
    for (RigCamera* camera : {&rig.left, &rig.right}) {
        fill(camera->intrinsic);
        fill(camera->rectifying);
        fill(camera->projection);
        camera->distortion = Distortion{5, {-0.1, 1e-300, 3e-17, 0, 0.25}};
    }
    fill(rig.rotation);
    fill(rig.reprojection);
    rig.translation_mm = {-84.985154252604417, 1.0 / 7, -1e-9};
    rig.near_mm = 300.1;
    rig.far_mm = 1200;
    std::strcpy(rig.calibrated_at, "2024-02-29T23:59:59Z");
    rig.quality = RigQuality{"usable", 13, 0.1, 1.0 / 3, 1e-300, 0, 2.5, {5e-324, 7, 8}, 400.25, 1.0 / 7 + 1000};

    const test::TempFolder folder;
    const std::string path = folder.path("rig.yaml");
    ASSERT_TRUE(write_rig_file(path.c_str(), rig).ok());
    const Result<RigFile> read = read_rig_file(path.c_str());
    ASSERT_TRUE(read.ok()) << read.status().message();
    EXPECT_EQ(read.value(), rig);
    EXPECT_EQ(folder.files(), 1U);
}

TEST(RigFile, ANumberThatIsNotFiniteIsNeverWritten)
{
    const test::TempFolder folder;
    const std::string path = folder.write("rig.yaml", std::string("yesterday's"));
    RigFile rig;
    rig.width = rig.height = 8;
    rig.quality.emplace().held_out_mm = std::numeric_limits<double>::quiet_NaN();
    const Status status = write_rig_file(path.c_str(), rig);
    EXPECT_EQ(status.fault(), Fault::kBadData);
    EXPECT_NE(std::strstr(status.message(), "held_out_mm is not finite"), nullptr) << status.message();
    rig.quality.reset();
    rig.right.intrinsic.emplace()[1][2] = std::numeric_limits<double>::infinity();
    EXPECT_NE(std::strstr(write_rig_file(path.c_str(), rig).message(), "K2 is not finite"), nullptr);
    EXPECT_EQ(test::bytes_of(path).size(), std::strlen("yesterday's"));
    EXPECT_EQ(folder.files(), 1U);
}

TEST(RigFile, UnwritableFolderIsNamed)
{
    RigFile rig;
    rig.width = rig.height = 1;
    EXPECT_EQ(write_rig_file("/nowhere/at/all/rig.yaml", rig).fault(), Fault::kCannotCreate);
    EXPECT_EQ(write_rig_file("/dev/full", rig).fault(), Fault::kIoError);
}

TEST(RigFile, MissingFileIsNoInput)
{
    const Result<RigFile> missing = read_rig_file("/nowhere/rig.yaml");
    EXPECT_EQ(missing.status().fault(), Fault::kNoInput);
    EXPECT_NE(std::strstr(missing.status().message(), "/nowhere/rig.yaml"), nullptr);
}

struct Refusal
{
    const char* name;
    std::string text;
    const char* says;
};

class RefusedRig : public testing::TestWithParam<Refusal>
{
};

TEST_P(RefusedRig, IsNamedWithTheFileAndTheReason)
{
    const Result<RigFile> rig = parsed(GetParam().text);
    const Status status = rig.ok() ? geometry_of(rig.value(), "rig.yaml").status() : rig.status();
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.fault(), Fault::kBadData);
    EXPECT_EQ(std::strncmp(status.message(), "rig.yaml: ", 10), 0) << status.message();
    EXPECT_NE(std::strstr(status.message(), GetParam().says), nullptr) << status.message();
}

std::string with(const std::string& extra)
{
    return kHead + extra + kP1 + kP2;
}

/// A quality with one value of its own.
std::string quality(const std::string& key, const std::string& value)
{
    std::string text = "quality:\n";
    for (const auto& [known, usual] : {std::pair{"verdict", "good"},
                                       {"pairs", "13"},
                                       {"rms_px", "0.2"},
                                       {"epipolar_rms_px", "0.1"},
                                       {"epipolar_p95_px", "0.2"},
                                       {"held_out_mm", "0.3"},
                                       {"held_out_depth_mm", "1"},
                                       {"depth_error_at_500mm_mm", "1"},
                                       {"depth_error_at_800mm_mm", "2"},
                                       {"depth_error_at_1000mm_mm", "3"},
                                       {"nearest_mm", "400"},
                                       {"farthest_mm", "900"}})
        text += std::string{"   "} + known + ": " + (key == known ? value : usual) + "\n";
    return text;
}

const Refusal kRefusals[] = {
    {"Empty", "", "nothing stands in it"},
    {"HeaderOnly", "%YAML:1.0", "nothing stands in it"},
    {"Xml", "<?xml version=\"1.0\"?>\n<opencv_storage>", "XML is not read"},
    {"Binary", std::string("\x89PNG\r\n\x1a\n\0\0", 10), "line 1"},
    {"NoMap", "%YAML:1.0\n---\n- 1\n- 2\n", "no rig's description"},
    {"NoSize", "%YAML:1.0\n---\n" + kP1 + kP2, "image_width"},
    {"AbsurdSize", "image_width: 70000\nimage_height: 480\n" + kP1 + kP2, "70000 x 480"},
    {"NegativeSize", "image_width: -640\nimage_height: 480\n" + kP1 + kP2, "-640 x 480"},
    {"FractionalSize", "image_width: 640.5\nimage_height: 480\n", "image_width must be a whole number"},
    {"NoProjections", kHead, "P1 is missing"},
    {"NoRightProjection", kHead + kP1, "P2 is missing"},
    {"WrongShape", with(matrix("K1", 3, 4, "1,2,3,4,5,6,7,8,9,10,11,12")), "K1 is a 3 x 4 matrix and must be 3 x 3"},
    {"TooFewNumbers", with(matrix("K1", 3, 3, "1,2,3")), "K1 must be a matrix with as many numbers as rows x cols"},
    {"TooManyNumbers", with(matrix("K1", 3, 3, "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17")), "16 numbers at most"},
    {"NegativeRows", with(matrix("K1", -3, -3, "1,2,3,4,5,6,7,8,9")), "rows x cols"},
    {"HugeRows", with(matrix("K1", 1000000000, 1000000000, "1,2,3,4,5,6,7,8,9")), "rows x cols"},
    {"NotANumber", with(matrix("R", 3, 3, "1,0,0, 0,.Nan,0, 0,0,1")), "R must be finite numbers"},
    {"LowerCaseNan", with(matrix("R", 3, 3, "1,0,0, 0,nan,0, 0,0,1")), "R must be finite numbers"},
    {"Infinite", with(matrix("T", 3, 1, "-60, 0, 1e999")), "T must be finite numbers"},
    {"SixDistortions", with(matrix("D1", 1, 6, "1,2,3,4,5,6")), "D1 is a 1 x 6 matrix"},
    {"IntegerMatrix", with("K1: !!opencv-matrix\n   rows: 1\n   cols: 1\n   dt: \"3u\"\n   data: [ 1 ]\n"),
     "dt d or f"},
    {"ScalarForMatrix", with("K1: 7\n"), "K1 must be an !!opencv-matrix"},
    {"NestedData", with("K1: { rows: 1, cols: 1, dt: d, data: [[1]] }\n"), "K1 must be finite numbers"},
    {"Twice", with(kP1), "P1 must be there once only"},
    {"Alias", with("a: &bomb [ 1, 2 ]\nb: *bomb\n"), "anchors"},
    {"AliasAlone", with("b: *bomb\n"), "references"},
    {"TooDeep", with("a: [[[[[[[[1]]]]]]]]\n"), "too many levels"},
    {"SecondDocument", kHead + kP1 + kP2 + "---\nimage_width: 1\n", "something follows"},
    {"TrailingGarbage", kHead + kP1 + kP2 + "...\n]]]\n", "not YAML"},
    {"CutShort", (kHead + kP1 + kP2).substr(0, kHead.size() + 80), "rig.yaml: line"},
    {"WrongUnit", with("unit: inch\n"), "unit must be mm or m"},
    {"NearBehindFar", with("near_mm: 900\nfar_mm: 300\n"), "far_mm above near_mm"},
    {"NegativeNear", with("near_mm: -1\n"), "above 0"},
    {"LongId", with("id: \"" + std::string(65, 'x') + "\"\n"), "id must be one word"},
    {"StrangeId", with("id: \"a\\\"b\"\n"), "id must be one word"},
    {"QualityIsNoMap", with("quality: 3\n"), "quality must be a map"},
    {"QualityCutShort", with("quality:\n   verdict: good\n   pairs: 13\n"), "quality must be whole"},
    {"QualityNan", with(quality("held_out_depth_mm", ".nan")), "held_out_depth_mm must be a finite number"},
    {"QualityInfinite", with(quality("depth_error_at_800mm_mm", "1e999")), "depth_error_at_800mm_mm must be a finite"},
    {"QualityNegative", with(quality("rms_px", "-0.1")), "rms_px must be 0 or more"},
    {"QualityVerdict", with(quality("verdict", "splendid")), "verdict must be good, usable or redo"},
    {"QualityTwice", with(quality("pairs", "7\n   pairs: 7")), "pairs must be there once only"},
    {"QualityRange", with(quality("farthest_mm", "1")), "farthest_mm must not be below nearest_mm"},
    {"NanNear", with("near_mm: .Nan\n"), "near_mm must be a finite number"},
    {"OverflowInMillimetres", with("unit: m\n" + matrix("T", 3, 1, "-1e306, 0, 0")), "in T is too large"},
    {"UnitTwice", with("unit: mm\nunit: mm\n"), "unit must be there once only"},
    {"RAndOm", with(matrix("R", 3, 3, "1,0,0, 0,1,0, 0,0,1") + matrix("om", 3, 1, "0,0,0")), "without R"},
    {"OmAndR", with(matrix("om", 3, 1, "0,0,0") + matrix("R", 3, 3, "1,0,0, 0,1,0, 0,0,1")),
     "R must be there once only"},
    {"LongOm", with(matrix("om", 3, 1, "0,3,3")), "half a circle at most"},
    {"SwappedCameras", kHead + kP1 + matrix("P2", 3, 4, "500,0,320,30000, 0,500,240,0, 0,0,1,0"), "swapped"},
    {"CamerasAboveEachOther", kHead + kP1 + matrix("P2", 3, 4, "500,0,320,0, 0,500,240,-30000, 0,0,1,0"),
     "above each other"},
    {"MetresWithoutUnit", kHead + kP1 + matrix("P2", 3, 4, "500,0,320,-30, 0,500,240,0, 0,0,1,0"), "unit: m"},
    {"DifferentFocals", kHead + kP1 + matrix("P2", 3, 4, "510,0,320,-30000, 0,510,240,0, 0,0,1,0"), "focal lengths"},
    {"DifferentRows", kHead + kP1 + matrix("P2", 3, 4, "500,0,320,-30000, 0,500,250,0, 0,0,1,0"), "same row"},
    {"NoProjection", kHead + kP1 + matrix("P2", 3, 4, "500,0,320,-30000, 0,500,240,0, 0,0,2,0"), "0 0 1 0"},
};

INSTANTIATE_TEST_SUITE_P(Of, RefusedRig, testing::ValuesIn(kRefusals),
                         [](const testing::TestParamInfo<Refusal>& tested) { return tested.param.name; });

TEST(RigFile, MoreThanAMebibyteIsRefused)
{
    const std::string large = kHead + "#" + std::string(kMaxRigFileBytes, ' ') + "\n" + kP1 + kP2;
    EXPECT_EQ(parsed(large).status().fault(), Fault::kBadData);
    const test::TempFolder folder;
    EXPECT_EQ(read_rig_file(folder.write("rig.yaml", large).c_str()).status().fault(), Fault::kBadData);
}

TEST(RigFile, ATruncatedFileNeverMakesAGeometry)
{
    const std::string whole = with("unit: mm\nid: abc\n");
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const Result<RigFile> rig = parsed(whole.substr(0, size));
        const bool usable = rig.ok() && geometry_of(rig.value(), "rig.yaml").ok();
        EXPECT_TRUE(!usable || size + 1 == whole.size()) << size; // only the last line's end may be missing
    }
}

} // namespace
} // namespace dicot
