// The two cameras that a configuration names, opened and ready to be planned with.
#pragma once

#include "../config/config.h"
#include "dicot/camera_rig/stereo_camera.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace dicot::app {

/// How time passes for recorded pictures.
enum class Pace
{
    kAtOnce, ///< waiting costs nothing, and every run is the same
    kReal,   ///< at their frame rate, as cameras would
};

/// Opens and owns them, and plans their modes. Nothing streams yet.
class CameraSource : public ModePlanner
{
public:
    /// Takes all memory that the cameras will ever need. Fault::kUnavailable: a camera is not there, cannot be opened,
    /// or is named by a serial number that two have; Fault::kConfig: it has no mode of the configured size and formats,
    /// or a replay script is wrong; Fault::kNoInput, kBadData: recorded pictures are missing or damaged.
    static Result<std::unique_ptr<CameraSource>> open(const CamerasConfig& config, Pace pace);
    virtual ~CameraSource() = default;

    virtual Camera& left() noexcept = 0;
    virtual Camera& right() noexcept = 0;
    /// Size of the pictures, px.
    virtual int width() const noexcept = 0;
    virtual int height() const noexcept = 0;
    virtual bool recorded() const noexcept = 0;
    /// What it holds in blocks of pages, as a MemoryReserve counts it.
    virtual std::size_t reserved_bytes() const noexcept = 0;
    /// The clock of recorded pictures at Pace::kAtOnce; else null.
    virtual std::int64_t* virtual_now_us() noexcept = 0;
};

/// Recorded pairs: `left` and `right` name folders (CameraBinding::what).
Result<std::unique_ptr<CameraSource>> open_replay(const CamerasConfig& config, Pace pace);
/// Cameras on USB, through the kernel's driver or libusb.
Result<std::unique_ptr<CameraSource>> open_usb_cameras(const CamerasConfig& config);

} // namespace dicot::app
