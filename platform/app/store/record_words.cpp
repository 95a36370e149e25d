#include "record_words.h"

#include "shown.h"

#include "dicot/base/utc_time.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>
#include <initializer_list>

namespace dicot::app {
namespace {

using nlohmann::json;

std::string line(const char* what, const std::string& text)
{
    char begin[32];
    std::snprintf(begin, sizeof begin, "  %-12s  ", what);
    return begin + text + "\n";
}

/// The value behind these keys; null if one of them is not there.
const json& at(const json& record, std::initializer_list<const char*> keys)
{
    static const json none;
    const json* value = &record;
    for (const char* key : keys) {
        if (!value->is_object() || !value->contains(key))
            return none;
        value = &(*value)[key];
    }
    return *value;
}

/// Text as it is, anything else as JSON; both escaped.
std::string words_of(const json& value)
{
    return shown(value.is_string() ? value.get_ref<const std::string&>()
                                   : value.dump(-1, ' ', true, json::error_handler_t::replace));
}

/// With so many digits behind the point; "?" of what is no number.
std::string number(const json& value, int digits, double scale = 1)
{
    if (!value.is_number())
        return "?";
    char text[48];
    std::snprintf(text, sizeof text, "%.*f", digits, value.get<double>() * scale);
    return text;
}

std::string temperatures(const json& sensors)
{
    constexpr std::size_t kMost = 8;
    std::string text;
    std::size_t count = 0;
    if (sensors.is_object())
        for (const auto& [name, celsius] : sensors.items())
            if (count++ < kMost)
                text += (text.empty() ? "" : ", ") + shown(name) + " " + number(celsius, 1) + " C";
    return text;
}

} // namespace

std::string row_words(const SlotRow& row)
{
    std::string text =
        line("time", std::string(utc_text(row.began_us).c_str()) + ", clock " + shown(row.clock_trust.view()));
    if (row.due_us)
        text += line("due", utc_text(*row.due_us).c_str());
    if (!row.done)
        text += line("reason", shown(row.reason.view()));
    text += line("size", shown_bytes(static_cast<double>(row.bytes)));
    text += line("pulled", row.pulled_us ? utc_text(*row.pulled_us).c_str() : "not yet");
    return text;
}

std::string record_words(const json& record)
{
    if (!record.is_object())
        return "";
    std::string text;
    const auto add = [&](const char* what, std::initializer_list<const char*> keys) {
        if (const json& value = at(record, keys); !value.is_null())
            text += line(what, words_of(value));
    };
    if (const json& plan = at(record, {"plan"}); plan.is_object()) {
        const json& woken = at(plan, {"woken"});
        text += line("plan", words_of(at(plan, {"why"})) +
                                 (woken.is_object() ? ", begun after rest: " + words_of(at(woken, {"rest"})) +
                                                          ", ended by " + words_of(at(woken, {"by"}))
                                                    : std::string{}));
    }
    add("source", {"source"});
    if (const json& cloud = at(record, {"cloud"}); cloud.is_object())
        text +=
            line("cloud", number(at(cloud, {"points"}), 0) + " points, " + number(at(cloud, {"bits_per_point"}), 1) +
                              " bits each; " + number(at(cloud, {"near_mm"}), 0) + " to " +
                              number(at(cloud, {"far_mm"}), 0) + " mm");
    if (const json& shot = at(record, {"shot"}); shot.is_object())
        text += line("pair", number(at(shot, {"pairs_used"}), 0) + " of " + number(at(shot, {"pairs"}), 0) +
                                 " pairs used, skew " + number(at(shot, {"skew_us"}), 1, 1e-3) + " ms, mean luma " +
                                 number(at(shot, {"mean_luma", "left"}), 0) + " and " +
                                 number(at(shot, {"mean_luma", "right"}), 0));
    for (const char* side : {"left", "right"})
        if (const json& camera = at(record, {"cameras", side}); camera.is_object())
            text += line(side, words_of(at(camera, {"name"})) + " at " + words_of(at(camera, {"port"})) + " through " +
                                   words_of(at(camera, {"driver"})));
    add("calibration", {"calibration_id"});
    add("clock", {"clock", "why"});
    if (const std::string warm = temperatures(at(record, {"temperatures_c"})); !warm.empty())
        text += line("temperature", warm);
    if (const json& times = at(record, {"cloud", "stages_s"}); times.is_object())
        text += line("seconds", "capture " + number(at(times, {"read"}), 2) + ", rectify " +
                                    number(at(times, {"rectify"}), 2) + ", match " + number(at(times, {"match"}), 2) +
                                    ", encode " + number(at(times, {"encode"}), 2));
    if (const json& peak = at(record, {"memory", "peak_resident_bytes"}); peak.is_number())
        text +=
            line("memory", shown_bytes(peak.get<double>()) + " at most, " +
                               number(at(record, {"memory", "arena_bytes"}), 1, 1.0 / (1 << 20)) + " MiB carved out");
    if (const json& warnings = at(record, {"warnings"}); warnings.is_array())
        for (const json& warning : warnings)
            text += line("warning", words_of(warning));
    if (const json& flags = at(record, {"health", "flags"}); flags.is_array())
        for (const json& flag : flags)
            text += line("health", words_of(at(flag, {"cause"})) + " " + words_of(at(flag, {"action"})));
    add("software", {"software"});
    return text;
}

} // namespace dicot::app
