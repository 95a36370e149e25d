#include "probe_report.h"

#include "dicot/uvc_parse/descriptors.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>

namespace dicot::app {
namespace {

constexpr std::size_t kMostModes = 256;
constexpr std::uint32_t kFastestUsual_100ns = 330'000; ///< 30 a second, as 333,333 and 333,667 name it

SeenCamera seen_by_descriptors(const UvcListed& listed)
{
    SeenCamera seen;
    seen.identity = listed.identity;
    seen.bus = listed.bus;
    seen.speed = listed.speed;
    seen.problem = listed.unusable;
    if (!listed.unusable.ok())
        return seen;
    seen.bulk = listed.device.bulk();
    seen.modes.resize(kMostModes);
    seen.modes.resize(modes_of(listed.device, seen.modes));
    seen.settings.resize(UvcDevice::kMostAlternates);
    seen.settings.resize(settings_of(listed.device, seen.settings));
    return seen;
}

/// The kernel's driver knows the camera too.
void add_node(SeenCamera& seen, const V4l2Node& node)
{
    const DeviceText<63> serial = seen.identity.serial;
    seen.identity = node.identity;
    if (node.identity.serial.text[0] == '\0')
        seen.identity.serial = serial;
    seen.node = node.path;
    seen.problem = {}; // descriptors that the kernel makes do with
}

auto preference(const StreamOffer& offer)
{
    constexpr std::int64_t kUsualPixels = std::int64_t{640} * 480;
    const CameraMode& mode = offer.mode;
    const std::int64_t pixels = std::int64_t{mode.width} * mode.height;
    const bool usual = mode.width == 640 && mode.height == 480;
    const bool larger = pixels > kUsualPixels;
    constexpr std::array kFormats{PixelFormat::kYuyv, PixelFormat::kNv12, PixelFormat::kMjpeg, PixelFormat::kGrey};
    return std::tuple{!usual,
                      larger,
                      larger ? pixels : -pixels,
                      mode.width,
                      std::ranges::find(kFormats, mode.format) - kFormats.begin(),
                      mode.interval_100ns < kFastestUsual_100ns,
                      mode.interval_100ns};
}

std::vector<StreamOffer> offers_of(const SeenCamera& camera)
{
    std::vector<StreamOffer> offers;
    for (std::size_t i = 0; i < camera.modes.size(); ++i)
        offers.push_back({camera.modes[i], i < camera.payload_bytes.size() ? camera.payload_bytes[i] : 0});
    std::ranges::stable_sort(offers, {}, preference);
    return offers;
}

BusUser user_of(const SeenCamera& camera, std::span<const StreamOffer> offers)
{
    return {.bus = camera.bus,
            .speed = camera.speed,
            .bulk = camera.bulk,
            .chooses_alternate = camera.node.empty(),
            .settings = camera.settings,
            .offers = offers};
}

} // namespace

std::vector<SeenCamera> seen_cameras(const V4l2Nodes& nodes, std::span<const UvcListed> listed)
{
    std::vector<SeenCamera> cameras;
    for (const UvcListed& one : listed)
        cameras.push_back(seen_by_descriptors(one));
    for (const V4l2Node& node : std::span{nodes.nodes}.first(static_cast<std::size_t>(nodes.count))) {
        const std::string_view port = node.identity.port.text;
        const auto same = [&](const SeenCamera& camera) { return port == camera.identity.port.text; };
        auto place = std::ranges::find_if(cameras, same);
        if (place == cameras.end()) {
            const UsbPlace usb = usb_place_of(node.identity.port.text);
            place = cameras.insert(cameras.end(), SeenCamera{});
            place->bus = usb.bus;
            place->speed = usb.speed;
        }
        if (place->node.empty())
            add_node(*place, node);
    }
    std::ranges::stable_sort(cameras, {},
                             [](const SeenCamera& camera) { return std::string_view{camera.identity.port.text}; });
    return cameras;
}

RigChoice choose_rig(std::span<const SeenCamera> cameras)
{
    RigChoice choice;
    for (const SeenCamera& camera : cameras) {
        if (camera.modes.empty())
            continue;
        if (choice.left != nullptr) {
            choice.right = &camera;
            break;
        }
        choice.left = &camera;
    }
    if (choice.right == nullptr) {
        choice.why = choice.left == nullptr
                         ? "no camera can be used; each one says why"
                         : std::string{"only the camera at "} + choice.left->identity.port.text +
                               " can be used, and a rig needs two; plug in a second one of the same model";
        choice.left = nullptr;
        return choice;
    }
    const std::vector<StreamOffer> left = offers_of(*choice.left);
    const std::vector<StreamOffer> right = offers_of(*choice.right);
    choice.plan = plan_bandwidth(user_of(*choice.left, left), user_of(*choice.right, right), 0);
    choice.why = choice.plan.why;
    for (const SeenCamera* camera : {choice.left, choice.right})
        if (!camera->problem.ok())
            choice.why += std::string{"; but first the camera at "} + camera->identity.port.text + " has to open";
    return choice;
}

Status no_camera(bool usb_listed, int denied)
{
    if (denied > 0)
        return failure(Fault::kUnavailable,
                       "no camera can be seen: %d video devices may not be opened by this user; add it to the group "
                       "video and log in again, or use recorded pairs (replay)",
                       denied);
    return failure(Fault::kUnavailable,
                   "there is no camera%s; plug in two webcams (this user needs the group video for /dev/video*, and "
                   "where the kernel has no driver for them a udev rule that lets it write to /dev/bus/usb), or use "
                   "recorded pairs (replay)",
                   usb_listed ? "" : ", and the kernel lists no USB devices");
}

} // namespace dicot::app
