// Probe and commit: how host and camera agree on a mode. UVC 1.1, 4.3.1.1.
#pragma once

#include "controls.h"
#include "model.h"

#include <cstdint>
#include <span>

namespace dicot::usbip {

/// What was agreed on.
struct Agreement
{
    std::size_t format = 0; ///< in CameraModel::formats
    std::size_t mode = 0;   ///< in Format::modes
    std::uint32_t interval_100ns = 0;
    std::uint32_t frame_bytes = 0;   ///< dwMaxVideoFrameSize
    std::uint32_t payload_bytes = 0; ///< dwMaxPayloadTransferSize
};

class Negotiation
{
public:
    static constexpr std::size_t kBytes10 = 26; ///< the structure of UVC 1.0
    static constexpr std::size_t kBytes11 = 34;

    /// `camera` is borrowed; it has at least one format, mode and rate.
    explicit Negotiation(const CameraModel& camera);

    /// A request to VS_PROBE_CONTROL or VS_COMMIT_CONTROL. A probe is mended to the nearest thing that the camera can
    /// do; a commit of anything else than a mode of the camera stalls.
    Reply request(int selector, int request, std::span<const std::uint8_t> data);

    const Agreement& committed() const { return committed_; }
    void reset() { probed_ = committed_ = usual(); }

private:
    Agreement mended(std::span<const std::uint8_t> data) const;
    Agreement completed(Agreement wish) const;
    Bytes bytes_of(const Agreement& agreement) const;
    Agreement usual() const;

    const CameraModel& camera_;
    Agreement probed_;
    Agreement committed_;
};

/// dwMaxPayloadTransferSize by the camera's policy: header included, and no more than its largest alternate setting.
std::uint32_t payload_bytes(const CameraModel& camera, std::uint32_t frame_bytes, std::uint32_t interval_100ns);

} // namespace dicot::usbip
