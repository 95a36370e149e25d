// What `dicot probe` tells, made out of what was seen: pure, so that it needs no camera.
#pragma once

#include "dicot/camera/bandwidth.h"
#include "dicot/camera/camera.h"
#include "dicot/uvc/uvc_list.h"
#include "dicot/v4l2/v4l2_camera.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dicot::app {

struct SeenControl
{
    ControlRange range;
    std::optional<std::int32_t> now; ///< nothing: the device does not tell
};

/// One camera, as its driver and its descriptors know it together.
struct SeenCamera
{
    CameraIdentity identity; ///< its driver is the one that would be used
    std::string node;        ///< "/dev/video0"; empty: the kernel's driver has none
    int bus = -1;            ///< negative: not on USB
    UsbSpeed speed = UsbSpeed::kHigh;
    bool bulk = false;
    std::vector<AlternateSetting> settings;   ///< empty: not known
    std::vector<CameraMode> modes;            ///< of the driver; of the descriptors where it cannot be opened
    std::vector<std::uint32_t> payload_bytes; ///< what the device asks for modes[i], where it was asked; else empty
    std::vector<SeenControl> controls;        ///< empty where it cannot be opened
    Status problem;                           ///< why it cannot be used
};

/// Both listings as one, a line a port, in order of the ports. The kernel's driver is preferred: where it has a node,
/// libusb would have to take the camera away from it. Of several nodes of a device the first counts.
std::vector<SeenCamera> seen_cameras(const V4l2Nodes& nodes, std::span<const UvcListed> listed);

/// Two cameras as a rig.
struct RigChoice
{
    const SeenCamera* left = nullptr; ///< null: `why` tells what is missing
    const SeenCamera* right = nullptr;
    BandwidthPlan plan;
    std::string why; ///< one sentence
};

/// The first two cameras with modes, and the bandwidth plan for them. Preferred: 640 x 480, what dicot matches unless
/// told otherwise, then smaller pictures, then larger ones; YUYV, NV12, MJPEG, GREY; 30 a second and less. Points into
/// `cameras`.
RigChoice choose_rig(std::span<const SeenCamera> cameras);

/// Why there is no camera, with the remedy: Fault::kUnavailable. `usb_listed` is whether the system lists USB devices,
/// `denied` how many video devices this user may not open.
Status no_camera(bool usb_listed, int denied);

std::string probe_text(std::span<const SeenCamera> cameras, const RigChoice& choice);
/// `problem` is null in JSON when it is ok.
std::string probe_json(std::span<const SeenCamera> cameras, const RigChoice& choice, int denied, const Status& problem);

} // namespace dicot::app
