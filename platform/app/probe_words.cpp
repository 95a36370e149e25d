// The report of dicot probe for a person, and for a program.
#include "probe_report.h"

#include <nlohmann/json.hpp>

#include <cstdarg>
#include <cstdio>

namespace dicot::app {
namespace {

__attribute__((format(printf, 2, 3))) void put(std::string& text, const char* format, ...)
{
    char line[640];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    text += line;
}

const char* name_of(UsbSpeed speed)
{
    switch (speed) {
    case UsbSpeed::kFull:
        return "full";
    case UsbSpeed::kHigh:
        return "high";
    case UsbSpeed::kSuper:
        return "super";
    }
    return "";
}

const char* name_of(Together together)
{
    switch (together) {
    case Together::kAtOnce:
        return "at once";
    case Together::kOneAfterTheOther:
        return "one after the other";
    case Together::kNotAtAll:
        return "not at all";
    }
    return "";
}

/// Frames a second to a tenth, 0 of a mode without an interval.
double rate_hz(const CameraMode& mode)
{
    const std::uint64_t interval = mode.interval_100ns;
    return interval == 0 ? 0 : static_cast<double>((100'000'000 + interval / 2) / interval) / 10;
}

bool has_ids(const CameraIdentity& identity)
{
    return identity.vendor != 0 || identity.product != 0;
}

std::string ids_of(const CameraIdentity& identity)
{
    std::string text;
    put(text, "%04x:%04x", unsigned{identity.vendor}, unsigned{identity.product});
    return text;
}

void put_modes(std::string& text, const SeenCamera& camera)
{
    const CameraMode* before = nullptr;
    for (const CameraMode& mode : camera.modes) {
        if (before == nullptr || before->format != mode.format || before->width != mode.width ||
            before->height != mode.height)
            put(text, "%s    %-5s %4d x %-4d at %.3g", before == nullptr ? "" : " /s\n", name_of(mode.format),
                mode.width, mode.height, rate_hz(mode));
        else
            put(text, ", %.3g", rate_hz(mode));
        before = &mode;
    }
    if (before != nullptr)
        text += " /s\n";
}

void put_camera(std::string& text, const SeenCamera& camera)
{
    const CameraIdentity& identity = camera.identity;
    put(text, "%s: %s", identity.port.text, identity.name.text[0] != '\0' ? identity.name.text : "(no name)");
    if (has_ids(identity))
        put(text, ", %s", ids_of(identity).c_str());
    put(text, ", %s%s, driver %s%s%s\n", identity.serial.text[0] != '\0' ? "serial " : "no serial",
        identity.serial.text, identity.driver, camera.node.empty() ? "" : ", ", camera.node.c_str());
    if (!camera.problem.ok())
        put(text, "    cannot be used: %s\n", camera.problem.message());
    if (camera.bus >= 0) {
        put(text, "    bus %d, %s speed", camera.bus, name_of(camera.speed));
        if (camera.settings.empty())
            text += ", alternate settings not known";
        else
            text += camera.bulk ? ", bulk" : ", bytes an interval of its alternate settings:";
        for (const AlternateSetting& setting : camera.settings) {
            if (camera.bulk)
                break;
            put(text, " %u: %u", unsigned{setting.number}, setting.bytes_per_interval);
            if (setting.intervals_apart > 1)
                put(text, " every %u", setting.intervals_apart);
        }
        text += "\n";
    }
    put_modes(text, camera);
    for (const auto& [range, now] : camera.controls) {
        put(text, "    %-20s %d .. %d, step %d, usual %d, now ", dicot::name_of(range.id), range.least, range.most,
            range.step, range.usual);
        text += now ? std::to_string(*now) + "\n" : "not told\n";
    }
}

nlohmann::json as_json(const CameraMode& mode)
{
    return {{"format", name_of(mode.format)},
            {"width", mode.width},
            {"height", mode.height},
            {"interval_100ns", mode.interval_100ns},
            {"rate_hz", rate_hz(mode)}};
}

nlohmann::json text_or_null(const char* text)
{
    return text[0] != '\0' ? nlohmann::json(text) : nlohmann::json();
}

nlohmann::json as_json(const SeenCamera& camera)
{
    const CameraIdentity& identity = camera.identity;
    nlohmann::json json = {{"port", identity.port.text},
                           {"name", identity.name.text},
                           {"ids", has_ids(identity) ? nlohmann::json(ids_of(identity)) : nlohmann::json()},
                           {"serial", text_or_null(identity.serial.text)},
                           {"driver", identity.driver},
                           {"node", text_or_null(camera.node.c_str())},
                           {"problem", text_or_null(camera.problem.message())},
                           {"usb", nullptr},
                           {"modes", nlohmann::json::array()},
                           {"controls", nlohmann::json::array()}};
    if (camera.bus >= 0) {
        nlohmann::json& usb = json["usb"];
        usb = {{"bus", camera.bus},
               {"speed", name_of(camera.speed)},
               {"bulk", camera.bulk},
               {"alternate_settings", nlohmann::json::array()}};
        for (const AlternateSetting& setting : camera.settings)
            usb["alternate_settings"].push_back({{"number", setting.number},
                                                 {"bytes_per_interval", setting.bytes_per_interval},
                                                 {"intervals_apart", setting.intervals_apart}});
    }
    for (std::size_t i = 0; i < camera.modes.size(); ++i) {
        nlohmann::json mode = as_json(camera.modes[i]);
        const bool asked = i < camera.payload_bytes.size() && camera.payload_bytes[i] != 0;
        mode["payload_bytes"] = asked ? nlohmann::json(camera.payload_bytes[i]) : nlohmann::json();
        json["modes"].push_back(std::move(mode));
    }
    for (const auto& [range, now] : camera.controls)
        json["controls"].push_back({{"name", dicot::name_of(range.id)},
                                    {"least", range.least},
                                    {"most", range.most},
                                    {"step", range.step},
                                    {"usual", range.usual},
                                    {"now", now ? nlohmann::json(*now) : nlohmann::json()}});
    return json;
}

nlohmann::json as_json(const SeenCamera& camera, const PlannedStream& stream, Together together)
{
    nlohmann::json json = {{"port", camera.identity.port.text}, {"driver", camera.identity.driver}, {"mode", nullptr}};
    if (together != Together::kNotAtAll)
        json.update({{"mode", as_json(stream.mode)},
                     {"alternate_setting", stream.alternate},
                     {"reserved_bytes_per_s", stream.reserved_bytes_per_s}});
    return json;
}

} // namespace

std::string probe_text(std::span<const SeenCamera> cameras, const RigChoice& choice)
{
    std::string text;
    for (const SeenCamera& camera : cameras)
        put_camera(text, camera);
    if (choice.left != nullptr && choice.right != nullptr)
        put(text, "left %s, right %s (the first two ports): ", choice.left->identity.port.text,
            choice.right->identity.port.text);
    return text + choice.why + "\n";
}

std::string probe_json(std::span<const SeenCamera> cameras, const RigChoice& choice, int denied, const Status& problem)
{
    nlohmann::json report = {{"cameras", nlohmann::json::array()},
                             {"denied_nodes", denied},
                             {"problem", text_or_null(problem.message())},
                             {"rig", nullptr}};
    for (const SeenCamera& camera : cameras)
        report["cameras"].push_back(as_json(camera));
    if (choice.left != nullptr && choice.right != nullptr)
        report["rig"] = {{"left", as_json(*choice.left, choice.plan.left, choice.plan.together)},
                         {"right", as_json(*choice.right, choice.plan.right, choice.plan.together)},
                         {"together", name_of(choice.plan.together)}};
    report["why"] = text_or_null(choice.why.c_str());
    return report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace dicot::app
