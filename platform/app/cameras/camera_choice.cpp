#include "camera_choice.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace dicot::app {
namespace {

std::string names_of(std::span<const SeenCamera> seen)
{
    std::string names;
    for (const SeenCamera& camera : seen) {
        names += names.empty() ? "" : ", ";
        names += camera.identity.port.text;
        if (camera.identity.serial.text[0] != '\0')
            names += std::string(" (serial ") + camera.identity.serial.text + ")";
    }
    return names.empty() ? "none" : names;
}

bool is_meant(const CameraBinding& binding, const SeenCamera& camera)
{
    switch (binding.by) {
    case BoundBy::kPort:
        return binding.what == camera.identity.port.text;
    case BoundBy::kSerial:
        return binding.what == camera.identity.serial.text;
    case BoundBy::kFirstFound:
        return camera.problem.ok();
    case BoundBy::kReplay:
        return false;
    }
    return false;
}

Result<const SeenCamera*> find(const char* side, const CameraBinding& binding, std::span<const SeenCamera> seen,
                               const SeenCamera* taken)
{
    const SeenCamera* found = nullptr;
    for (const SeenCamera& camera : seen) {
        if (&camera == taken || !is_meant(binding, camera))
            continue;
        if (found != nullptr && binding.by == BoundBy::kSerial)
            return failure(Fault::kUnavailable,
                           "%s: two cameras have the serial number %s, at %s and %s: bind them by port", side,
                           binding.what.c_str(), found->identity.port.text, camera.identity.port.text);
        if (found == nullptr)
            found = &camera;
    }
    if (found == nullptr && binding.by == BoundBy::kFirstFound)
        return failure(Fault::kUnavailable,
                       "%s: no camera is left for it, a rig needs two; there are: %s ('dicot probe' shows more)", side,
                       names_of(seen).c_str());
    if (found == nullptr && taken != nullptr && is_meant(binding, *taken))
        return failure(Fault::kConfig, "%s: '%s' is the camera at %s, which stands on the other side already", side,
                       binding.what.c_str(), taken->identity.port.text);
    if (found == nullptr)
        return failure(Fault::kUnavailable, "%s: there is no camera '%s'; there are: %s ('dicot probe' shows more)",
                       side, binding.what.c_str(), names_of(seen).c_str());
    if (!found->problem.ok())
        return found->problem;
    return found;
}

std::string words_of(const CameraMode& mode)
{
    return std::string(name_of(mode.format)) + " " + std::to_string(mode.width) + "x" + std::to_string(mode.height);
}

} // namespace

Result<ChosenCameras> choose_cameras(const CamerasConfig& config, std::span<const SeenCamera> seen)
{
    ChosenCameras chosen;
    // What is named goes first, so that "the first one that is left" can be no camera that the other side names.
    if (config.left.by == BoundBy::kFirstFound && config.right.by != BoundBy::kFirstFound) {
        chosen.right = TRY(find("cameras.right", config.right, seen, nullptr));
        chosen.left = TRY(find("cameras.left", config.left, seen, chosen.right));
        return chosen;
    }
    chosen.left = TRY(find("cameras.left", config.left, seen, nullptr));
    chosen.right = TRY(find("cameras.right", config.right, seen, chosen.left));
    return chosen;
}

bool opens_through_kernel(const SeenCamera& camera, const std::string& driver) noexcept
{
    return driver == "v4l2" || (driver == "auto" && !camera.node.empty());
}

Result<std::vector<StreamOffer>> offers_for(const CamerasConfig& config, const Camera& camera)
{
    constexpr std::uint32_t kTolerancePercent = 1; // 30 a second is called 333,333 and 333,667
    const std::uint32_t least_interval =
        10'000'000U / static_cast<std::uint32_t>(config.fps) * (100 - kTolerancePercent) / 100;
    const auto rank = [&](PixelFormat format) {
        return std::ranges::find(config.formats, format) - config.formats.begin();
    };
    std::vector<StreamOffer> offers;
    std::set<std::string> others;
    for (const CameraMode& mode : camera.modes()) {
        const bool right_size = mode.width == config.width && mode.height == config.height;
        const bool known = rank(mode.format) < static_cast<std::ptrdiff_t>(config.formats.size());
        if (right_size && known)
            offers.push_back({mode, 0});
        else
            others.insert(words_of(mode));
    }
    // Cameras without a rate that is slow enough deliver faster than was asked for; that is no reason to do without.
    const auto too_fast = [&](const StreamOffer& offer) { return offer.mode.interval_100ns < least_interval; };
    std::ranges::stable_sort(offers, {}, [&](const StreamOffer& offer) {
        return std::tuple{rank(offer.mode.format), too_fast(offer), offer.mode.interval_100ns};
    });
    if (!offers.empty())
        return offers;
    std::string list;
    for (const std::string& other : others)
        list += (list.empty() ? "" : ", ") + other;
    return failure(Fault::kConfig, "the camera at %s has no mode of %d x %d px in the configured formats; it has: %s",
                   camera.identity().port.text, config.width, config.height, list.empty() ? "none" : list.c_str());
}

std::size_t largest_frame(const CamerasConfig& config) noexcept
{
    return frame_bytes({PixelFormat::kYuyv, config.width, config.height, 0});
}

} // namespace dicot::app
