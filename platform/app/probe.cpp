// dicot probe: which cameras are there, what they can do, and what would be used. Nothing streams.
#include "commands.h"
#include "probe_report.h"

#include "dicot/os/clock.h"
#include "dicot/uvc/uvc_camera.h"

#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

/// After which a camera is asked no further; the answer that is waited for then may take its driver's own bound longer.
constexpr std::int64_t kPatienceUs = 3'000'000;

void ask(Camera& camera, SeenCamera& seen)
{
    seen.modes.assign(camera.modes().begin(), camera.modes().end());
    const std::int64_t deadline = monotonic_us() + kPatienceUs;
    for (const ControlRange& range : camera.controls()) {
        SeenControl& control = seen.controls.emplace_back(SeenControl{range, {}});
        if (monotonic_us() >= deadline)
            continue;
        if (const Result<std::int32_t> now = camera.get(range.id); now.ok())
            control.now = now.value();
    }
}

void look_through_kernel(SeenCamera& seen)
{
    V4l2Camera camera;
    seen.problem = camera.open(seen.node.c_str());
    if (seen.problem.ok())
        ask(camera, seen);
}

void look_through_libusb(SeenCamera& seen)
{
    constexpr UvcOptions kSmall{.slots = UvcOptions::kFewestSlots, .slot_bytes = 4096}; // nothing will stream
    const Result<std::unique_ptr<UvcCamera>> opened = UvcCamera::open(seen.identity.port.text, kSmall);
    seen.problem = opened.status();
    if (!opened.ok())
        return;
    UvcCamera& camera = *opened.value();
    ask(camera, seen);
    const std::int64_t deadline = monotonic_us() + kPatienceUs;
    for (const CameraMode& mode : seen.modes) {
        if (monotonic_us() >= deadline)
            break;
        const Result<std::uint32_t> payload = camera.payload_bytes(mode);
        seen.payload_bytes.push_back(payload.ok() ? payload.value() : 0);
    }
}

/// Fills in what only an opened camera tells.
void look_closer(SeenCamera& seen, int denied)
{
    if (!seen.node.empty())
        look_through_kernel(seen);
    else if (seen.problem.ok() &&
             denied > 0) // the kernel's driver has it, most likely: it is not taken away for a look
        seen.problem = failure(Fault::kUnavailable,
                               "the camera at USB port %s: this user may not open the kernel's video devices; add it "
                               "to the group video and log in again",
                               seen.identity.port.text);
    else if (seen.problem.ok())
        look_through_libusb(seen);
}

Status run(bool json)
{
    const V4l2Nodes nodes = list_v4l2_cameras();
    const Result<std::vector<UvcListed>> listed = list_uvc_cameras();
    std::vector<SeenCamera> cameras =
        seen_cameras(nodes, listed.ok() ? std::span<const UvcListed>{listed.value()} : std::span<const UvcListed>{});
    for (SeenCamera& seen : cameras)
        look_closer(seen, nodes.denied);
    const Status status = cameras.empty() ? no_camera(listed.ok(), nodes.denied) : Status{};
    const RigChoice choice = cameras.empty() ? RigChoice{} : choose_rig(cameras);
    if (json)
        std::fputs(probe_json(cameras, choice, nodes.denied, status).c_str(), stdout);
    else if (!cameras.empty())
        std::fputs(probe_text(cameras, choice).c_str(), stdout);
    return status;
}

} // namespace

void add_probe(CLI::App& program, Command& chosen)
{
    CLI::App* command =
        program.add_subcommand("probe", "Cameras: what is there, what it can do, what would be used and why");
    auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "report as JSON");
    command->callback([json, &chosen] { chosen = [json] { return run(*json); }; });
}

} // namespace dicot::app
