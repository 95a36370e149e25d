// What the program is told by its file: which cameras, how they are used, where results go.
#pragma once

#include "dicot/base/status.h"
#include "dicot/camera/mode.h"
#include "dicot/matching/matcher.h"
#include "dicot/schedule/schedule.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dicot::app {

inline constexpr const char* kDefaultConfigFile = "/etc/dicot/dicot.toml";

enum class BoundBy
{
    kFirstFound, ///< the first one by USB port that the other side has not taken
    kPort,       ///< CameraIdentity::port
    kSerial,     ///< CameraIdentity::serial
    kReplay,     ///< a folder of recorded pairs
};

/// Which camera stands on a side.
struct CameraBinding
{
    BoundBy by = BoundBy::kFirstFound;
    std::string what; ///< the port, the serial number or the folder; empty of kFirstFound

    friend bool operator==(const CameraBinding&, const CameraBinding&) = default;
};

struct CamerasConfig
{
    CameraBinding left, right;   ///< either both are kReplay or none is
    std::string driver = "auto"; ///< "auto": the kernel's where it has the camera, "v4l2", "uvc"
    /// In order of preference, each at most once; recorded pictures keep their own.
    std::vector<PixelFormat> formats{PixelFormat::kYuyv, PixelFormat::kNv12, PixelFormat::kMjpeg, PixelFormat::kGrey};
    int width = 640; ///< px
    int height = 480;
    int fps = 30;                    ///< frames a second at most
    std::string replay_script;       ///< of both cameras, as parse_replay_script() reads it
    std::string replay_script_left;  ///< what is added for the left one
    std::string replay_script_right; ///< and for the right one

    std::string left_script() const { return replay_script + "\n" + replay_script_left; }
    std::string right_script() const { return replay_script + "\n" + replay_script_right; }
};

struct ExposureConfig
{
    bool lock = true;       ///< one camera finds it, both keep it
    int power_line_hz = 50; ///< 0: no flicker, 50, 60
    double warm_up_s = 20;  ///< given up after so long
};

struct BurstConfig
{
    int frames = 8; ///< pairs that are looked at for one snapshot
    bool average = true;
    double most_skew_ms = 10;
    bool one_after_the_other = true; ///< allowed where both cameras do not fit on their bus
};

struct RigConfig
{
    std::string file = "/etc/dicot/rig.yaml";
    std::optional<double> near_mm; ///< none: the rig file's
    std::optional<double> far_mm;
};

/// As the words of the same names on the command line (match_words.h).
struct MatchingConfig
{
    std::string method = "standard"; ///< "paper", "fast", "standard", "best"
    std::string cost = "adcensus";   ///< "adcensus", "tad"
    int window = MatchOptions{}.window;
    double gamma_color = MatchOptions{}.gamma_color;
    double gamma_space = MatchOptions{}.gamma_space;
    std::string cpu = "auto"; ///< "auto", "scalar", "avx2", "neon"
    int threads = 0;          ///< 0: one for each processor
};

struct OutputConfig
{
    std::string folder = ".";     ///< around the folders of devices
    std::string device;           ///< empty: the host's name
    int reserve_mib = 256;        ///< of the file system, left to others
    std::string prune = "pulled"; ///< "never", "pulled", "all"
    bool keep_raw = false;
};

struct PowerConfig
{
    std::string between = "idle";  ///< "idle", "suspend", "off"
    std::string cameras = "auto";  ///< "auto", "on", "port"
    std::string rtc = "/dev/rtc0"; ///< the clock whose alarm wakes the board
    int least_rest_s = 120;        ///< shorter pauses are idled
};

struct WatchdogConfig
{
    std::string device; ///< empty: none
    int stage_s = 900;  ///< bound of one stage of a slot
};

struct RunConfig
{
    std::string state = "/var/lib/dicot/state"; ///< folder of what one start leaves for the next
    bool lock_memory = true;
    int most_memory_mib = 0; ///< 0: no limit
};

/// The board as a device that a computer takes clouds from.
struct UsbConfig
{
    bool export_store = false;     ///< by dicot run; key "export"
    bool marks = true;             ///< a host that has verified a snapshot may mark it as pulled
    std::string clock = "not set"; ///< when a host's time is taken: "never", "not set"
    std::string serial;            ///< as the host sees it; empty: made of the board's machine-id
    std::string udc;               ///< of /sys/class/udc; empty: the first one
};

/// Everything that a file may say, as its sections; what stands here is what holds without a file. Ranges and meanings:
/// config_keys.h.
struct Config
{
    CamerasConfig cameras;
    ExposureConfig exposure;
    BurstConfig burst;
    RigConfig rig;
    MatchingConfig matching;
    OutputConfig output;
    PowerConfig power;
    WatchdogConfig watchdog;
    RunConfig run;
    ScheduleConfig schedule;
    UsbConfig usb;
};

/// A configuration, and where it comes from.
struct LoadedConfig
{
    Config config;
    std::string file;       ///< empty: no file was read
    std::vector<int> lines; ///< of each of config_keys() where it stands in the file, from 1; 0: it does not
};

/// Reads TOML 1.0 of at most kMostConfigBytes. `name` stands for the file in sentences; relative paths are taken from
/// `folder`, if that is not empty. Fault::kConfig with `name` and the line: no TOML, an unknown section or key, a value
/// of another type or out of its range, values that contradict each other. Takes memory from the heap.
Result<LoadedConfig> parse_config(std::string_view text, const std::string& name, const std::string& folder);
inline constexpr std::size_t kMostConfigBytes = std::size_t{64} * 1024;

/// The file at `path`; without a path the one at `usual_path` if there is one, else the defaults.
/// Errors: those of parse_config(), Fault::kNoInput, kIoError.
Result<LoadedConfig> load_config(const std::string& path, const char* usual_path = kDefaultConfigFile);

} // namespace dicot::app
