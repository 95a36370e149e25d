#include "gadget_status.h"

#include "dicot/base/utc_time.h"

#include <cinttypes>
#include <cstdio>

namespace dicot::app {
namespace {

/// VmRSS of another process; 0: it does not tell.
std::uint64_t resident_of(pid_t process)
{
    char path[64];
    std::snprintf(path, sizeof path, "/proc/%d/status", static_cast<int>(process));
    std::FILE* const file = std::fopen(path, "re");
    if (file == nullptr)
        return 0;
    std::uint64_t kib = 0;
    char line[256];
    while (std::fgets(line, sizeof line, file) != nullptr)
        if (std::sscanf(line, "VmRSS: %" SCNu64, &kib) == 1)
            break;
    std::fclose(file);
    return kib * 1024;
}

double mib(std::uint64_t bytes)
{
    return static_cast<double>(bytes) / (1024 * 1024);
}

} // namespace

GadgetStatus gadget_status(const GadgetPlaces& places, const std::string& wanted_controller)
{
    const UsbGadget gadget(places);
    GadgetStatus status;
    status.prepared = gadget.prepared();
    status.controller = gadget.bound_to();
    status.bound = !status.controller.empty();
    if (!status.bound) {
        const Result<std::string> found = gadget.controller(wanted_controller);
        if (found.ok())
            status.controller = found.value();
        else
            status.why = found.status().message();
    }
    if (!status.controller.empty()) {
        status.state = controller_state(places, status.controller);
        status.speed = controller_speed(places, status.controller);
    }
    status.server = look_at_server(places.server());
    if (status.server)
        status.resident_bytes = resident_of(status.server->process);
    return status;
}

nlohmann::json gadget_json(const GadgetStatus& status)
{
    nlohmann::json all = {{"prepared", status.prepared}, {"bound", status.bound}};
    all["controller"] = status.controller.empty() ? nlohmann::json() : nlohmann::json(status.controller);
    if (!status.why.empty())
        all["why"] = status.why;
    else
        all.update({{"state", status.state}, {"speed", status.speed}});
    all["server"] = nullptr;
    if (status.server) {
        const SeenServer& seen = *status.server;
        all["server"] = {{"pid", seen.process},
                         {"began", utc_text(static_cast<std::int64_t>(seen.began_us)).c_str()},
                         {"session_open", seen.session_open != 0},
                         {"sessions", seen.sessions},
                         {"requests", seen.requests},
                         {"refused", seen.refused},
                         {"cancelled", seen.cancelled},
                         {"given_up", seen.given_up},
                         {"files_sent", seen.objects_sent},
                         {"bytes_sent", seen.bytes_sent},
                         {"snapshots_marked", seen.marked},
                         {"computers", seen.hosts},
                         {"resets", seen.resets},
                         {"events_dropped", seen.events_dropped},
                         {"memory", {{"fixed_bytes", seen.fixed_bytes}, {"resident_bytes", status.resident_bytes}}}};
    }
    return all;
}

std::string gadget_text(const GadgetStatus& status)
{
    std::string text;
    if (!status.why.empty())
        text += "port      " + status.why + "\n";
    else
        text += "port      " + status.controller + ": " + (status.state.empty() ? "?" : status.state) +
                (status.state == "configured" ? ", " + status.speed : "") + "\n";
    text += std::string("gadget    ") +
            (status.bound
                 ? (status.state == "configured" ? "bound, and a computer sees it" : "bound: no computer sees it now")
             : status.prepared ? "prepared, not bound"
                               : "not prepared: 'dicot gadget up' as root") +
            "\n";
    if (!status.server)
        return text + "served    by nobody\n";
    const SeenServer& seen = *status.server;
    char lines[640];
    std::snprintf(lines, sizeof lines,
                  "served    by process %d since %s\n"
                  "session   %s; %" PRIu64 " so far, from %" PRIu64 " times that a computer came\n"
                  "answered  %" PRIu64 " requests, %" PRIu64 " of them refused, %" PRIu64 " cancelled\n"
                  "sent      %" PRIu64 " files, %.1f MiB; %" PRIu64 " snapshots marked as pulled\n"
                  "memory    %.1f MiB of %.1f at most\n",
                  static_cast<int>(seen.process), utc_text(static_cast<std::int64_t>(seen.began_us)).c_str(),
                  seen.session_open != 0 ? "open" : "none", seen.sessions, seen.hosts, seen.requests, seen.refused,
                  seen.cancelled, seen.objects_sent, mib(seen.bytes_sent), seen.marked, mib(status.resident_bytes),
                  mib(seen.fixed_bytes));
    return text + lines;
}

} // namespace dicot::app
