#include "config_keys.h"

#include "dicot/kernels/kernels.h"
#include "dicot/os/thread_crew.h"

namespace dicot::app {
namespace {

template <typename Value, auto Section, auto Member>
constexpr Reach<Value> reach()
{
    return {[](Config& config) -> Value& { return (config.*Section).*Member; },
            [](const Config& config) -> const Value& { return (config.*Section).*Member; }};
}

template <auto Member>
constexpr auto cameras_text = reach<std::string, &Config::cameras, Member>();
template <auto Member>
constexpr auto cameras_whole = reach<int, &Config::cameras, Member>();
template <auto Member>
constexpr auto matching_text = reach<std::string, &Config::matching, Member>();
template <auto Member>
constexpr auto matching_number = reach<double, &Config::matching, Member>();
template <auto Member>
constexpr auto schedule_text = reach<std::string, &Config::schedule, Member>();

constexpr const char* kDrivers[] = {"auto", "v4l2", "uvc"};
constexpr PixelFormat kFormats[] = {PixelFormat::kYuyv, PixelFormat::kNv12, PixelFormat::kMjpeg, PixelFormat::kGrey};
constexpr int kPowerLines[] = {0, 50, 60};
constexpr const char* kMethods[] = {"paper", "fast", "standard", "best"};
constexpr const char* kCosts[] = {"adcensus", "tad"};
constexpr const char* kCpus[] = {"auto", "scalar", "avx2", "neon"};
constexpr const char* kPrunes[] = {"never", "pulled", "all"};
constexpr const char* kHostClocks[] = {"never", "not set"};
constexpr const char* kBetweens[] = {"idle", "suspend", "off"};
constexpr const char* kCamerasBetween[] = {"auto", "on", "port"};
constexpr const char* kZones = R"("" (the system's), a name of the IANA database, or a rule as POSIX has it in TZ)";
constexpr const char* kMoments = R"("06:30", "sunrise" or "sunset", these also as "sunrise+30m" or "sunset-1h30m")";
constexpr const char* kIntervals = R"("" (not), or a time from 1m to 24h, as "30m", "2h" or "1h30m")";
constexpr const char* kClocks = R"(a time from "00:00" to "24:00")";
constexpr int kMostReserveMib = 1 << 20;
constexpr int kMostMemoryMib = 1 << 20;
constexpr double kFarthestMm = 1'000'000; // as for calibrate

bool is_moment(std::string_view text)
{
    return parse_moment(text).has_value();
}

bool is_clock(std::string_view text)
{
    return parse_clock_s(text).has_value();
}

const ConfigKey kKeys[] = {
    {"cameras", "left", "", "The camera on the left; dicot probe lists ports and serial numbers",
     BindingKey{reach<CameraBinding, &Config::cameras, &CamerasConfig::left>()}},
    {"cameras", "right", "", "The camera on the right; one folder may hold the recorded pictures of both",
     BindingKey{reach<CameraBinding, &Config::cameras, &CamerasConfig::right>()}},
    {"cameras", "driver", "", "The kernel's driver, or libusb; auto: the kernel's where it has the camera",
     ChoiceKey{cameras_text<&CamerasConfig::driver>, kDrivers}},
    {"cameras", "formats", "", "What the cameras may send, in order of preference",
     FormatsKey{reach<std::vector<PixelFormat>, &Config::cameras, &CamerasConfig::formats>(), kFormats}},
    {"cameras", "width", "px", "Width of a picture, as in the rig file",
     WholeKey{cameras_whole<&CamerasConfig::width>, 16, 8192, {}}},
    {"cameras", "height", "px", "Height of a picture, as in the rig file",
     WholeKey{cameras_whole<&CamerasConfig::height>, 16, 8192, {}}},
    {"cameras", "fps", "frames/s", "The rate at most; less where the bus is too narrow",
     WholeKey{cameras_whole<&CamerasConfig::fps>, 1, 240, {}}},
    {"cameras", "replay_script", "", "Rate and faults of recorded pictures, for trials",
     ScriptKey{cameras_text<&CamerasConfig::replay_script>}},
    {"cameras", "replay_script_left", "", "More of it, for the left camera alone",
     ScriptKey{cameras_text<&CamerasConfig::replay_script_left>}},
    {"cameras", "replay_script_right", "", "More of it, for the right camera alone",
     ScriptKey{cameras_text<&CamerasConfig::replay_script_right>}},

    {"exposure", "lock", "", "One camera finds exposure, gain and white balance; both keep them",
     FlagKey{reach<bool, &Config::exposure, &ExposureConfig::lock>()}},
    {"exposure", "power_line_hz", "Hz", "Of the power line, on which lamps flicker; 0: they do not",
     WholeKey{reach<int, &Config::exposure, &ExposureConfig::power_line_hz>(), 0, 60, kPowerLines}},
    {"exposure", "warm_up_s", "s", "Time at most until the brightness rests; then pictures are taken all the same",
     NumberKey{reach<double, &Config::exposure, &ExposureConfig::warm_up_s>(), 0.5, 120}},

    {"burst", "frames", "pairs", "How many are looked at for one snapshot",
     WholeKey{reach<int, &Config::burst, &BurstConfig::frames>(), 1, 64, {}}},
    {"burst", "average", "", "Resting pixels are averaged over the burst: less noise",
     FlagKey{reach<bool, &Config::burst, &BurstConfig::average>()}},
    {"burst", "most_skew_ms", "ms", "Time between left and right at most; a pair that is further apart is refused",
     NumberKey{reach<double, &Config::burst, &BurstConfig::most_skew_ms>(), 0.1, 1000}},
    {"burst", "one_after_the_other", "", "Allowed if the bus does not carry both cameras at once",
     FlagKey{reach<bool, &Config::burst, &BurstConfig::one_after_the_other>()}},

    {"rig", "file", "", "The rig file, as dicot calibrate writes it",
     PathKey{reach<std::string, &Config::rig, &RigConfig::file>()}},
    {"rig", "near_mm", "mm", "Where the plants begin; open: the rig file's",
     OpenNumberKey{reach<std::optional<double>, &Config::rig, &RigConfig::near_mm>(), 1, kFarthestMm}},
    {"rig", "far_mm", "mm", "Where they end; open: the rig file's",
     OpenNumberKey{reach<std::optional<double>, &Config::rig, &RigConfig::far_mm>(), 1, kFarthestMm}},

    {"matching", "method", "",
     "paper: the published equations alone; fast: a seventh of standard's time; best: the most exact, twice its time",
     ChoiceKey{matching_text<&MatchingConfig::method>, kMethods}},
    {"matching", "cost", "", "AD-Census, or truncated absolute differences",
     ChoiceKey{matching_text<&MatchingConfig::cost>, kCosts}},
    {"matching", "window", "px", "Side of the support window",
     WholeKey{reach<int, &Config::matching, &MatchingConfig::window>(), 3, kMaxWindow, {}, true}},
    {"matching", "gamma_color", "CIELAB units", "Colour tolerance of the support weights",
     NumberKey{matching_number<&MatchingConfig::gamma_color>, 0.5, 100}},
    {"matching", "gamma_space", "px", "Reach of the support weights",
     NumberKey{matching_number<&MatchingConfig::gamma_space>, 0.5, 1000}},
    {"matching", "cpu", "", "Instruction set; never changes the result",
     ChoiceKey{matching_text<&MatchingConfig::cpu>, kCpus}},
    {"matching", "threads", "", "Worker threads, 0: one for each processor; never changes the result",
     WholeKey{reach<int, &Config::matching, &MatchingConfig::threads>(), 0, ThreadCrew::kMaxThreads, {}}},

    {"output", "folder", "",
     "Where snapshots go, each board's in a folder of its own; without this key the folder that dicot is started in",
     PathKey{reach<std::string, &Config::output, &OutputConfig::folder>()}},
    {"output", "device", "", "The board's name, of its folder in there and in every cloud",
     NameKey{reach<std::string, &Config::output, &OutputConfig::device>()}},
    {"output", "reserve_mib", "MiB", "What snapshots leave free of the disk or card",
     WholeKey{reach<int, &Config::output, &OutputConfig::reserve_mib>(), 0, kMostReserveMib, {}}},
    {"output", "prune", "", "What may be deleted to make room, oldest first; pulled: what a host has, verified",
     ChoiceKey{reach<std::string, &Config::output, &OutputConfig::prune>(), kPrunes}},
    {"output", "keep_raw", "", "Both pictures are kept as the cameras saw them too, as PNG",
     FlagKey{reach<bool, &Config::output, &OutputConfig::keep_raw>()}},

    {"schedule", "timezone", "", "Where clocks show the times below, daylight saving included, as Europe/Berlin",
     WordKey{schedule_text<&ScheduleConfig::timezone>, is_zone_text, kZones}},
    {"schedule", "at", "", "Times of the day at which dicot run takes a snapshot; dicot schedule lists what comes",
     WordsKey{reach<std::vector<std::string>, &Config::schedule, &ScheduleConfig::at>(), is_moment, kMoments,
              Schedule::kMostMoments}},
    {"schedule", "every", "", "And one every so often, counted from from",
     WordKey{schedule_text<&ScheduleConfig::every>, is_interval, kIntervals}},
    {"schedule", "from", "", "Of every: the first one of each day",
     WordKey{schedule_text<&ScheduleConfig::from>, is_clock, kClocks}},
    {"schedule", "until", "", "Of every: none is later; 24:00 is the end of the day",
     WordKey{schedule_text<&ScheduleConfig::until>, is_clock, kClocks}},
    {"schedule", "latitude", "degrees", "Of the place, for sunrise and sunset; north is positive",
     OpenNumberKey{reach<std::optional<double>, &Config::schedule, &ScheduleConfig::latitude>(), -90, 90}},
    {"schedule", "longitude", "degrees", "Of the place; east is positive",
     OpenNumberKey{reach<std::optional<double>, &Config::schedule, &ScheduleConfig::longitude>(), -180, 180}},
    {"schedule", "late_min", "min", "A snapshot that could not begin so long after its time is missed",
     WholeKey{reach<int, &Config::schedule, &ScheduleConfig::late_min>(), 0, 720, {}}},

    {"power", "between", "",
     "What the board does between two slots; off: it is powered off until the alarm of its clock",
     ChoiceKey{reach<std::string, &Config::power, &PowerConfig::between>(), kBetweens}},
    {"power", "cameras", "", "The cameras then; auto: the kernel suspends them, port: their USB ports are switched off",
     ChoiceKey{reach<std::string, &Config::power, &PowerConfig::cameras>(), kCamerasBetween}},
    {"power", "rtc", "", "The clock that runs while the board sleeps, and wakes it",
     PathKey{reach<std::string, &Config::power, &PowerConfig::rtc>()}},
    {"power", "least_rest_s", "s", "Shorter pauses are idled",
     WholeKey{reach<int, &Config::power, &PowerConfig::least_rest_s>(), 5, 86'400, {}}},

    {"watchdog", "device", "", "The board's own, which resets it; \"\": systemd's watchdog alone",
     PathKey{reach<std::string, &Config::watchdog, &WatchdogConfig::device>(), true}},
    {"watchdog", "stage_s", "s", "Bound of one stage of a slot; one that is longer is aborted, and the slot is missed",
     WholeKey{reach<int, &Config::watchdog, &WatchdogConfig::stage_s>(), 10, 21'600, {}}},

    {"run", "state", "", "Folder of what one start of dicot run leaves for the next",
     PathKey{reach<std::string, &Config::run, &RunConfig::state>()}},
    {"run", "lock_memory", "", "Its memory stays in RAM, where the system allows it",
     FlagKey{reach<bool, &Config::run, &RunConfig::lock_memory>()}},
    {"run", "most_memory_mib", "MiB", "Of memory that dicot run may take; more is refused at its start; 0: no limit",
     WholeKey{reach<int, &Config::run, &RunConfig::most_memory_mib>(), 0, kMostMemoryMib, {}}},

    {"usb", "export", "", "A computer that is plugged into the board's USB device port may take clouds from it (MTP)",
     FlagKey{reach<bool, &Config::usb, &UsbConfig::export_store>()}},
    {"usb", "marks", "", "dicot pull may mark there what it has and has verified; nothing else can be written",
     FlagKey{reach<bool, &Config::usb, &UsbConfig::marks>()}},
    {"usb", "clock", "",
     "When the time that dicot pull --set-clock offers is taken; not set: while the board knows none",
     ChoiceKey{reach<std::string, &Config::usb, &UsbConfig::clock>(), kHostClocks}},
    {"usb", "serial", "", "Serial number that the computer sees; \"\": made of the board's own number",
     NameKey{reach<std::string, &Config::usb, &UsbConfig::serial>(), "the board's own"}},
    {"usb", "udc", "", "USB device controller, as /sys/class/udc names it; \"\": the first one",
     NameKey{reach<std::string, &Config::usb, &UsbConfig::udc>(), "the first one"}},
};

} // namespace

std::span<const ConfigKey> config_keys()
{
    return kKeys;
}

} // namespace dicot::app
