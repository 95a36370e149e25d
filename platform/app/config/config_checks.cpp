#include "config_checks.h"
#include "config_keys.h"

#include "dicot/os/shown_path.h"
#include "dicot/replay/replay_script.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace dicot::app {
namespace {

/// The last line of those that say one of these keys: where the contradiction arises.
int line_of(const LoadedConfig& loaded, const char* section, std::span<const char* const> names)
{
    int line = 0;
    for (std::size_t i = 0; i < loaded.lines.size(); ++i)
        for (const char* name : names)
            if (std::strcmp(config_keys()[i].section, section) == 0 && std::strcmp(config_keys()[i].name, name) == 0)
                line = std::max(line, loaded.lines[i]);
    return line;
}

int line_of(const LoadedConfig& loaded, const char* section, std::initializer_list<const char*> names)
{
    return line_of(loaded, section, std::span{names.begin(), names.size()});
}

Status check_bindings(const LoadedConfig& loaded, const char* file)
{
    const CameraBinding& left = loaded.config.cameras.left;
    const CameraBinding& right = loaded.config.cameras.right;
    const int line = line_of(loaded, "cameras", {"left", "right"});
    if ((left.by == BoundBy::kReplay) != (right.by == BoundBy::kReplay))
        return failure(Fault::kConfig,
                       "%s:%d: [cameras] recorded pictures on the %s side alone: bind both sides to a folder "
                       "(\"replay:FOLDER\", the same one may hold both) or to cameras",
                       file, line, left.by == BoundBy::kReplay ? "left" : "right");
    if (left == right && (left.by == BoundBy::kPort || left.by == BoundBy::kSerial))
        return failure(Fault::kConfig,
                       "%s:%d: [cameras] left and right are both \"%s\": one camera cannot stand on both sides; dicot "
                       "probe lists the cameras",
                       file, line, text_of(left).c_str());
    return {};
}

Status check_scripts(const LoadedConfig& loaded, const char* file)
{
    const auto check = [&](const char* key, const std::string& script) {
        char name[300];
        std::snprintf(name, sizeof name, "%s:%d: [cameras] replay_script and %s together", file,
                      line_of(loaded, "cameras", {"replay_script", key}), key);
        return parse_replay_script(script, name).status();
    };
    TRY(check("replay_script_left", loaded.config.cameras.left_script()));
    return check("replay_script_right", loaded.config.cameras.right_script());
}

Status check_schedule(const LoadedConfig& loaded, const char* file)
{
    const ScheduleConfig& schedule = loaded.config.schedule;
    if (const std::optional<Contradiction> found = contradiction_in(schedule))
        return failure(Fault::kConfig, "%s:%d: [schedule] %s", file, line_of(loaded, "schedule", found->keys),
                       found->why);
    if (schedule.timezone.empty()) // the system's is no fault of this file
        return {};
    const Status zone = TimeZone::open(schedule.timezone).status();
    return zone.ok() ? zone
                     : failure(Fault::kConfig, "%s:%d: [schedule] timezone: %s", file,
                               line_of(loaded, "schedule", {"timezone"}), zone.message());
}

/// A port that is off has no camera that could be found by another word.
Status check_power(const LoadedConfig& loaded, const char* file)
{
    const Config& config = loaded.config;
    for (const CameraBinding& side : {config.cameras.left, config.cameras.right})
        if (config.power.cameras == "port" && side.by != BoundBy::kPort && side.by != BoundBy::kReplay)
            return failure(Fault::kConfig,
                           "%s:%d: [power] cameras = \"port\" needs cameras that are bound by port, as \"port:1-1.2\"; "
                           "dicot probe lists them",
                           file, line_of(loaded, "power", {"cameras"}));
    constexpr std::size_t kMostDevice = 127, kMostState = 240;
    if (config.power.rtc.size() > kMostDevice || config.watchdog.device.size() > kMostDevice ||
        config.run.state.size() > kMostState)
        return failure(Fault::kConfig,
                       "%s: power.rtc, watchdog.device (127 bytes at most) or run.state (240) is too long", file);
    return {};
}

} // namespace

Status check_together(const LoadedConfig& loaded)
{
    const char* file = shown_path(loaded.file.c_str());
    TRY(check_bindings(loaded, file));
    TRY(check_scripts(loaded, file));
    TRY(check_schedule(loaded, file));
    TRY(check_power(loaded, file));
    const RigConfig& rig = loaded.config.rig;
    if (rig.near_mm && rig.far_mm && *rig.near_mm >= *rig.far_mm)
        return failure(Fault::kConfig,
                       "%s:%d: [rig] near_mm is %g and far_mm %g: the plants must begin before they end", file,
                       line_of(loaded, "rig", {"near_mm", "far_mm"}), *rig.near_mm, *rig.far_mm);
    return {};
}

} // namespace dicot::app
