#include "config/config.h"
#include "config/config_keys.h"
#include "config/device_name.h"
#include "temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace dicot::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

Result<LoadedConfig> parse(const std::string& text, const std::string& folder = "")
{
    return parse_config(text, "t.toml", folder);
}

std::string complaint(const std::string& text)
{
    const Status status = parse(text).status();
    EXPECT_EQ(status.fault(), Fault::kConfig) << text;
    return status.message();
}

/// What a key is promised to take and to refuse, as TOML has it.
struct Promise
{
    const char* section;
    const char* key;
    std::vector<const char*> takes;
    std::vector<const char*> refuses;
};

const Promise kPromises[] = {
    {"cameras",
     "left",
     {R"("")", R"("port:1-1.2")", R"("serial:A B\"\\")", R"("port:platform:csi")"},
     {R"("1-")", R"("1")", R"("-1")", R"("1-1.")", R"("1-1-2")", R"("port:")", R"("serial:")", R"("replay:")",
      R"("video0")", R"("serial:a\nb")", R"("serial:ä")", R"("port:12345678901234567890123456789012")", "1",
      R"(["1-1"])"}},
    {"cameras", "right", {R"("")", R"("port:10-4")"}, {R"("usb")", "true", "{}"}},
    {"cameras", "driver", {R"("auto")", R"("v4l2")", R"("uvc")"}, {R"("")", R"("V4L2")", "0", R"(["uvc"])"}},
    {"cameras",
     "formats",
     {R"(["GREY"])", R"(["MJPEG", "YUYV", "GREY", "NV12"])"},
     {"[]", R"("YUYV")", R"(["yuyv"])", R"(["RGB24"])", R"(["YUYV", "YUYV"])", "[1]", R"(["YUYV", 1])"}},
    {"cameras",
     "width",
     {"16", "8192"},
     {"15", "8193", "-640", "640.0", "\"640\"", "9223372036854775807", "1979-05-27"}},
    {"cameras", "height", {"16", "8192"}, {"15", "8193", "4294967776", "true"}},
    {"cameras", "fps", {"1", "240"}, {"0", "241", "29.97"}},
    {"cameras",
     "replay_script",
     {R"("")", R"("rate 5\ndrop 3; torn 4 # why")"},
     {"5", R"("rate 0")", R"("rate 5\ndrip")"}},
    {"cameras", "replay_script_left", {R"("")", R"("skew_us -300")"}, {"[]", R"("left")"}},
    {"cameras", "replay_script_right", {R"("")", R"("gone 9 port")"}, {"{}", R"("gone")"}},
    {"exposure", "lock", {"true", "false"}, {"1", "\"true\"", "[true]"}},
    {"exposure", "power_line_hz", {"0", "50", "60"}, {"1", "49", "55", "61", "50.0", "\"50\""}},
    {"exposure", "warm_up_s", {"0.5", "120", "3"}, {"0.49", "120.5", "-1", "nan", "inf", "\"20\""}},
    {"burst", "frames", {"1", "64"}, {"0", "65", "8.5"}},
    {"burst", "average", {"true", "false"}, {"0", "\"no\""}},
    {"burst", "most_skew_ms", {"0.1", "1000"}, {"0.09", "1000.1", "0", "-inf", "true"}},
    {"burst", "one_after_the_other", {"true", "false"}, {"1"}},
    {"rig", "file", {R"("/a/b.yaml")"}, {R"("")", R"("a\u0000b")", R"("a\u001b")", "1", "false"}},
    {"rig", "near_mm", {"1", "1000000", "250.5"}, {"0.5", "1000001", "nan", "\"1\""}},
    {"rig", "far_mm", {"1", "1000000"}, {"0", "1000000.5", "[]"}},
    {"matching", "method", {R"("paper")", R"("fast")", R"("standard")", R"("best")"}, {R"("quick")", "1"}},
    {"matching", "cost", {R"("adcensus")", R"("tad")"}, {R"("census")", "true"}},
    {"matching", "window", {"3", "33", "35"}, {"1", "2", "34", "37", "-3", "5.0"}},
    {"matching", "gamma_color", {"0.5", "100"}, {"0.4", "100.1"}},
    {"matching", "gamma_space", {"0.5", "1000"}, {"0.4", "1000.1"}},
    {"matching", "cpu", {R"("auto")", R"("scalar")", R"("avx2")", R"("neon")"}, {R"("sse")", "2"}},
    {"matching", "threads", {"0", "64"}, {"-1", "65"}},
    {"output", "folder", {R"("/ä/\"b\"")"}, {R"("")", "1", R"("a\nb")"}},
    {"output",
     "device",
     {R"("")", R"("Bench-3.left_row")", R"("2026-06-011")",
      R"("123456789012345678901234567890123456789012345678901234567890123")"},
     {R"("..")", R"(".hidden")", R"("-o")", R"("a/b")", R"("a b")", R"("ä")", R"("2026-06-01")", "7", R"("a\n")",
      R"("1234567890123456789012345678901234567890123456789012345678901234")"}},
    {"output", "reserve_mib", {"0", "1048576"}, {"-1", "1048577", "1.5", "\"256\""}},
    {"output", "prune", {R"("never")", R"("pulled")", R"("all")"}, {R"("")", R"("oldest")", "false"}},
    {"output", "keep_raw", {"true", "false"}, {"0", "\"yes\""}},
    {"power", "between", {R"("idle")", R"("suspend")", R"("off")"}, {R"("")", R"("sleep")", "0"}},
    {"power", "cameras", {R"("auto")", R"("on")"}, {R"("off")", "true"}},
    {"power", "rtc", {R"("/dev/rtc1")"}, {R"("")", "0"}},
    {"power", "least_rest_s", {"5", "86400"}, {"4", "86401", "60.0"}},
    {"watchdog", "device", {R"("")", R"("/dev/watchdog0")"}, {"true", R"("a\nb")"}},
    {"watchdog", "stage_s", {"10", "21600"}, {"9", "21601", "\"900\""}},
    {"usb", "export", {"true", "false"}, {"1", R"("yes")"}},
    {"usb", "marks", {"true", "false"}, {"0"}},
    {"usb", "clock", {R"("never")", R"("not set")"}, {R"("always")", "true"}},
    {"usb", "serial", {R"("")", R"("GREENHOUSE-07")"}, {R"("a b")", "7", R"("..")"}},
    {"usb", "udc", {R"("")", R"("fe980000.usb")"}, {R"("a/b")", "[]"}},
    {"run", "state", {R"("/s/t")"}, {R"("")", "[]"}},
    {"run", "lock_memory", {"true", "false"}, {"1"}},
    {"schedule",
     "timezone",
     {R"("")", R"("UTC")", R"("CET-1CEST,M3.5.0,M10.5.0/3")", R"("<+0545>-5:45")"},
     {R"("a b")", R"("Europe\\Berlin")", R"("ä")", R"("UTC\n")", "1", "[]"}},
    {"schedule",
     "at",
     {"[]", R"(["06:30"])", R"(["12:00", "00:00", "23:59"])"},
     {R"("06:30")", R"(["6:30"])", R"(["24:00"])", R"(["noon"])", R"(["sunrise+13h"])", R"(["06:30", ""])", "[630]",
      "06:30:00"}},
    {"schedule",
     "every",
     {R"("")", R"("1m")", R"("24h")", R"("1h30m")"},
     {R"("0m")", R"("24h1m")", R"("30")", R"("2 h")", "2", R"("2H")"}},
    {"schedule",
     "from",
     {R"("00:00")", R"("23:59")"},
     {R"("24:01")", R"("6:00")", R"("sunrise")", R"("")", "06:00:00", "6"}},
    {"schedule", "until", {R"("24:00")", R"("00:01")"}, {R"("24:01")", R"("12:60")", R"("")", "24"}},
    {"schedule", "latitude", {"-90", "90", "52.52"}, {"-90.1", "90.1", "nan", "\"52N\""}},
    {"schedule", "longitude", {"-180", "180"}, {"-180.5", "181", "[13.4]"}},
    {"schedule", "late_min", {"0", "720"}, {"-1", "721", "1.5", "\"15m\""}},
    {"run", "most_memory_mib", {"0", "1048576"}, {"-1", "1048577", "64.5", "\"64\""}},
};

const ConfigKey* known(const Promise& promise, std::size_t& place)
{
    for (place = 0; place < config_keys().size(); ++place)
        if (const ConfigKey& key = config_keys()[place];
            std::string{promise.section} == key.section && std::string{promise.key} == key.name)
            return &key;
    return nullptr;
}

std::string file_with(const Promise& promise, const char* value)
{
    return std::string{"["} + promise.section + "]\n" + promise.key + " = " + value + "\n";
}

TEST(Config, EveryKeyTakesItsBoundsAsTheyAre)
{
    EXPECT_EQ(std::size(kPromises), config_keys().size()) << "a key without a promise";
    for (const Promise& promise : kPromises) {
        std::size_t place = 0;
        const ConfigKey* key = known(promise, place);
        ASSERT_NE(key, nullptr) << promise.section << "." << promise.key;
        for (const char* value : promise.takes) {
            const Result<LoadedConfig> got = parse(file_with(promise, value));
            ASSERT_TRUE(got.ok()) << got.status().message();
            const std::string shown = toml_of(*key, got.value().config);
            if (!std::holds_alternative<FormatsKey>(key->kind) && !std::holds_alternative<ScriptKey>(key->kind)) {
                EXPECT_EQ(shown, value) << promise.section << "." << promise.key;
            }
            for (std::size_t i = 0; i < got.value().lines.size(); ++i)
                EXPECT_EQ(got.value().lines[i], i == place ? 2 : 0);
            for (const ConfigKey& one : config_keys()) {
                EXPECT_TRUE(&one == key || toml_of(one, got.value().config) == toml_of(one, Config{}))
                    << promise.key << " changed " << one.name;
            }
        }
    }
}

TEST(Config, AHostsNameIsMadeFitToBeADevices)
{
    EXPECT_EQ(device_name_near("bench-3.local"), "bench-3.local");
    EXPECT_EQ(device_name_near("Grüne Wand"), "Gr--ne-Wand");
    EXPECT_EQ(device_name_near("../etc"), "etc");
    EXPECT_EQ(device_name_near("2026-06-01"), "dicot");
    EXPECT_EQ(device_name_near("\xFF\xFE"), "dicot");
    EXPECT_EQ(device_name_near(""), "dicot");
    EXPECT_EQ(device_name_near(std::string(300, 'x')), std::string(63, 'x'));
}

TEST(Config, EveryKeyRefusesWhatLiesBeyondWithPlaceAndRemedy)
{
    for (const Promise& promise : kPromises) {
        std::size_t place = 0;
        const ConfigKey* key = known(promise, place);
        ASSERT_NE(key, nullptr);
        for (const char* value : promise.refuses) {
            const std::string said = complaint(file_with(promise, value));
            EXPECT_THAT(said, StartsWith(std::string{"t.toml:2: ["} + promise.section + "] " + promise.key)) << value;
            if (!std::holds_alternative<ScriptKey>(key->kind)) {
                EXPECT_THAT(said, HasSubstr("give " + allowed_of(*key))) << value;
            }
        }
    }
}

TEST(Config, WithoutAFileTheWrittenDefaultsHold)
{
    const Config config = parse("").value().config;
    EXPECT_EQ(config.cameras.left.by, BoundBy::kFirstFound);
    EXPECT_EQ(config.cameras.right.by, BoundBy::kFirstFound);
    EXPECT_EQ(config.cameras.driver, "auto");
    EXPECT_THAT(config.cameras.formats,
                ElementsAre(PixelFormat::kYuyv, PixelFormat::kNv12, PixelFormat::kMjpeg, PixelFormat::kGrey));
    EXPECT_EQ(config.cameras.width, 640);
    EXPECT_EQ(config.cameras.height, 480);
    EXPECT_EQ(config.cameras.fps, 30);
    EXPECT_TRUE(config.exposure.lock);
    EXPECT_EQ(config.exposure.power_line_hz, 50);
    EXPECT_EQ(config.exposure.warm_up_s, 20);
    EXPECT_EQ(config.burst.frames, 8);
    EXPECT_TRUE(config.burst.average);
    EXPECT_EQ(config.burst.most_skew_ms, 10);
    EXPECT_TRUE(config.burst.one_after_the_other);
    EXPECT_EQ(config.rig.file, "/etc/dicot/rig.yaml");
    EXPECT_FALSE(config.rig.near_mm || config.rig.far_mm);
    EXPECT_EQ(config.matching.window, 35);
    EXPECT_EQ(config.output.folder, ".");
    EXPECT_EQ(config.schedule.timezone, "");
    EXPECT_TRUE(config.schedule.at.empty() && config.schedule.every.empty());
    EXPECT_EQ(config.schedule.from, "00:00");
    EXPECT_EQ(config.schedule.until, "24:00");
    EXPECT_EQ(config.schedule.late_min, 15);
}

TEST(Config, ABareUsbPortIsAPort)
{
    for (const char* port : {"1-1", "1-1.2", "12-34.5.6.7"}) {
        const CameraBinding left = parse("cameras.left = \"" + std::string{port} + "\"").value().config.cameras.left;
        EXPECT_EQ(left, (CameraBinding{BoundBy::kPort, port}));
    }
}

TEST(Config, FormatsKeepTheirOrder)
{
    EXPECT_THAT(parse("cameras.formats = ['MJPEG', 'YUYV']").value().config.cameras.formats,
                ElementsAre(PixelFormat::kMjpeg, PixelFormat::kYuyv));
}

TEST(Config, WhatIsNotKnownIsNamedWithTheNearestThatIs)
{
    const struct
    {
        const char* text;
        const char* said;
    } kCases[] = {
        {"[cameras]\nwidht = 3", "t.toml:2: there is no key widht in [cameras]: did you mean width?"},
        {"[cameras]\n\n\nframe = 3", "t.toml:4: there is no key frame in [cameras]: did you mean frames in [burst]?"},
        {"[rig]\nfps = 3", "t.toml:2: there is no key fps in [rig]: did you mean fps in [cameras]?"},
        {"[camera]\nwidth = 3", "t.toml:1: there is no section [camera]: did you mean [cameras]?"},
        {"\n[ouptut]", "t.toml:2: there is no section [ouptut]: did you mean [output]?"},
        {"width = 3", "t.toml:1: width stands outside of a section: did you mean width below [cameras]?"},
        {"rig = 'a'", "t.toml:1: rig is \"a\": it is a section, write [rig] and its keys below"},
        {"[[burst]]\nframes = 3",
         "t.toml:1: burst is a list of other things: it is a section, write [burst] and its keys below"},
        {"[cameras]\n\"\\u001b[2J\" = 1", "t.toml:2: there is no key ?[2J in [cameras]: did you mean left?"},
    };
    for (const auto& one : kCases)
        EXPECT_EQ(complaint(one.text), one.said);
}

TEST(Config, TheFirstFaultOfTheFileIsTold)
{
    EXPECT_THAT(complaint("[rig]\nnear_mm = 0\n[burst]\nframes = 0\n"), StartsWith("t.toml:2: "));
    EXPECT_THAT(complaint("[rig]\nnear_mm = 2\n[burst]\nframes = 0\n"), StartsWith("t.toml:4: "));
}

TEST(Config, WhatIsNoTomlIsToldWithItsLine)
{
    for (const char* text : {"[burst]\nframes = = 3", "[burst]\nframes 3", "[burst]\n'", "[rig]\n[burst",
                             "[rig]\n\xff = 3", "[burst]\nframes = 99999999999999999999", "[rig]\nfile = \"a"})
        EXPECT_THAT(complaint(text), StartsWith("t.toml:2: this is not TOML: ")) << text;
    EXPECT_THAT(complaint("[burst]\nframes = 3\nframes = 4\n"), StartsWith("t.toml:3: this is not TOML: "));
    EXPECT_THAT(complaint("[burst]\n[rig]\n[burst]\n"), StartsWith("t.toml:3: this is not TOML: "));
}

TEST(Config, WhatIsNotUtf8IsToldWithItsLine)
{
    // the borders of Unicode 15, table 3-7
    for (const char* good : {"\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80", "\xef\xbf\xbd",
                             "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"})
        EXPECT_TRUE(parse(std::string{"[rig]\nfile = 'a"} + good + "b'").ok()) << good;
    for (const char* bad : {"\x80", "\xbf", "\xc1\xbf", "\xc2", "\xc2\xc2", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xe1\x80",
                            "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff", "\xf1\x80\x80"}) {
        EXPECT_THAT(complaint(std::string{"[rig]\nfile = 'a"} + bad + "b'"),
                    HasSubstr("t.toml:2: this is not TOML: the line is not UTF-8"));
        EXPECT_THAT(complaint(std::string{"[rig]\n# "} + bad), StartsWith("t.toml:2: "));
    }
}

TEST(Config, LettersOfOtherAlphabetsOutsideOfTextsAreNoToml)
{
    for (const char* letter : {"\xc2\xa1", "\xc3\x86", "\xd2\x99", "\xe2\x80\xb0", "\xef\xbb\xbe", "\xe4\xb8\x80"})
        for (const std::string text : {"frames = 3", "frames = ", "frames"}) {
            EXPECT_THAT(complaint("[burst]\n" + text + letter), StartsWith("t.toml:2: this is not TOML: ")) << letter;
            EXPECT_THAT(complaint("[burst]\n" + text + " " + letter), StartsWith("t.toml:2: this is not TOML: "))
                << letter;
        }
}

TEST(Config, OneCameraCannotStandOnBothSides)
{
    EXPECT_THAT(complaint("[cameras]\nright = '1-1'\nleft = 'port:1-1'\n"),
                StartsWith("t.toml:3: [cameras] left and right are both \"port:1-1\""));
    EXPECT_THAT(complaint("[cameras]\nleft = 'serial:1-1'\nright = 'serial:1-1'\n"), StartsWith("t.toml:3: "));
    EXPECT_TRUE(parse("[cameras]\nleft = 'serial:1-1'\nright = '1-1'\n").ok());
    EXPECT_TRUE(parse("[cameras]\nleft = 'replay:a'\nright = 'replay:a'\n").ok());
    EXPECT_TRUE(parse("[cameras]\nleft = ''\nright = ''\n").ok());
}

TEST(Config, RecordedPicturesStandOnBothSidesOrOnNone)
{
    EXPECT_THAT(complaint("[cameras]\nleft = 'replay:a'\n"),
                StartsWith("t.toml:2: [cameras] recorded pictures on the left"));
    EXPECT_THAT(complaint("[cameras]\nleft = '1-1'\nright = 'replay:a'\n"),
                StartsWith("t.toml:3: [cameras] recorded pictures on the right"));
}

TEST(Config, PlantsBeginBeforeTheyEnd)
{
    EXPECT_THAT(complaint("[rig]\nfar_mm = 200\nnear_mm = 200\n"),
                StartsWith("t.toml:3: [rig] near_mm is 200 and far_mm 200"));
    EXPECT_TRUE(parse("[rig]\nfar_mm = 200\nnear_mm = 199.9\n").ok());
}

TEST(Config, PortsAreSwitchedOnlyOfCamerasThatAreBoundByPort)
{
    const std::string port = "[power]\ncameras = 'port'\n";
    EXPECT_THAT(complaint(port),
                StartsWith("t.toml:2: [power] cameras = \"port\" needs cameras that are bound by port"));
    EXPECT_THAT(complaint(port + "[cameras]\nleft = '1-1'\nright = 'serial:A'"), StartsWith("t.toml:2: "));
    EXPECT_EQ(parse(port + "[cameras]\nleft = '1-1'\nright = '1-2'").value().config.power.cameras, "port");
    EXPECT_TRUE(parse(port + "[cameras]\nleft = 'replay:a'\nright = 'replay:a'").ok());
}

TEST(Config, PathsThatAreKeptWithoutAHeapHaveALength)
{
    const std::string name(126, 'x');
    EXPECT_TRUE(parse("[power]\nrtc = '/" + name + "'").ok());
    EXPECT_THAT(complaint("[power]\nrtc = '/" + name + "x'"), StartsWith("t.toml:2: [power] rtc has 128 bytes"));
    EXPECT_THAT(complaint("[watchdog]\ndevice = '/" + name + "x'"), StartsWith("t.toml:2: [watchdog] device"));
    EXPECT_THAT(complaint("[run]\nstate = '/" + name + name + "'"), StartsWith("t.toml:2: [run] state"));
}

TEST(Config, NoWatchdogStaysNone)
{
    EXPECT_EQ(parse("[watchdog]\ndevice = ''", "/etc/dicot").value().config.watchdog.device, "");
    EXPECT_EQ(parse("[watchdog]\ndevice = 'dog'", "/etc/dicot").value().config.watchdog.device, "/etc/dicot/dog");
}

TEST(Config, ASchedulesContradictionsAreToldWithTheLastOfTheirLines)
{
    EXPECT_THAT(complaint("[schedule]\nlongitude = 13.4\nat = ['06:30', 'sunset']\nlate_min = 3\n"),
                StartsWith("t.toml:3: [schedule] at tells times by the sun"));
    EXPECT_THAT(complaint("[schedule]\nuntil = '06:00'\nevery = '1h'\nfrom = '20:00'\n[output]\n"),
                StartsWith("t.toml:4: [schedule] from is not before until"));
    EXPECT_THAT(complaint("[schedule]\nevery = '2h'\nfrom = '06:00'\nuntil = '07:59'\n"),
                StartsWith("t.toml:4: [schedule] every is longer"));
    EXPECT_TRUE(parse("[schedule]\nevery = '2h'\nfrom = '06:00'\nuntil = '08:00'\n").ok());
    EXPECT_TRUE(parse("[schedule]\nat = ['sunset']\nlatitude = 1\nlongitude = 1\n").ok());
}

TEST(Config, ATimeZoneThatIsNotThereIsToldWithItsLine)
{
    for (const char* name : {"Mars/Olympus", "CET-1CEST", "../UTC", "/etc/localtime"})
        EXPECT_THAT(complaint(std::string{"[schedule]\n\ntimezone = '"} + name + "'\n"),
                    StartsWith(std::string{"t.toml:3: [schedule] timezone: there is no time zone \""} + name))
            << name;
}

TEST(Config, ScriptsOfBothAndOfOneAreOneScript)
{
    const Config config = parse("[cameras]\nreplay_script = 'drop 1'\nreplay_script_left = 'drop 2'\n").value().config;
    EXPECT_EQ(config.cameras.left_script(), "drop 1\ndrop 2");
    EXPECT_EQ(config.cameras.right_script(), "drop 1\n");
    EXPECT_THAT(
        complaint("[cameras]\nreplay_script = 'control gain 0 9 1 5'\nreplay_script_right = 'control gain 0 9 1 5'"),
        StartsWith("t.toml:3: [cameras] replay_script and replay_script_right together: line 2: "));
}

TEST(Config, RelativePathsBeginAtTheFile)
{
    const std::string text = "[cameras]\nleft = 'replay:pairs'\nright = 'replay:/pairs'\n[rig]\nfile = './my.yaml'\n"
                             "[output]\nfolder = '.'\n";
    const Config config = parse(text, "/etc/dicot").value().config;
    EXPECT_EQ(config.cameras.left.what, "/etc/dicot/pairs");
    EXPECT_EQ(config.cameras.right.what, "/pairs");
    EXPECT_EQ(config.rig.file, "/etc/dicot/my.yaml");
    EXPECT_EQ(config.output.folder, "/etc/dicot");
    EXPECT_EQ(parse("", "/etc/dicot").value().config.output.folder, ".") << "a default is not of the file";
    EXPECT_EQ(parse("rig.file = '../a'", "/").value().config.rig.file, "/../a");
}

TEST(ConfigFile, TheNamedOneComesBeforeTheUsualOne)
{
    const test::TempFolder folder;
    const std::string usual = folder.write("usual.toml", "burst.frames = 2");
    const std::string named = folder.write("named.toml", "burst.frames = 3\nrig.file = 'r.yaml'");
    const LoadedConfig got = load_config(named, usual.c_str()).value();
    EXPECT_EQ(got.config.burst.frames, 3);
    EXPECT_EQ(got.config.rig.file, folder.path("r.yaml"));
    EXPECT_EQ(got.file, named);
    EXPECT_EQ(load_config("", usual.c_str()).value().config.burst.frames, 2);
    const LoadedConfig none = load_config("", folder.path("absent.toml").c_str()).value();
    EXPECT_EQ(none.config.burst.frames, 8);
    EXPECT_EQ(none.file, "");
    EXPECT_EQ(none.lines, std::vector<int>(config_keys().size(), 0));
    EXPECT_EQ(load_config(folder.path("absent.toml"), usual.c_str()).status().fault(), Fault::kNoInput);
    EXPECT_EQ(load_config(folder.path(""), usual.c_str()).status().fault(), Fault::kNoInput);
}

TEST(ConfigFile, NoFileIsLargerThanAConfiguration)
{
    const test::TempFolder folder;
    const std::string just = folder.write("just.toml", std::string(kMostConfigBytes, '\n'));
    const std::string more = folder.write("more.toml", std::string(kMostConfigBytes + 1, '\n'));
    EXPECT_TRUE(load_config(just).ok());
    EXPECT_EQ(load_config(more).status().fault(), Fault::kConfig);
    EXPECT_THAT(load_config(more).status().message(), HasSubstr("more.toml"));
}

} // namespace
} // namespace dicot::app
