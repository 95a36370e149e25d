// Which of the cameras that are there a configuration means, and in which modes. Pure.
#pragma once

#include "../config/config.h"
#include "../probe_report.h"

#include <cstddef>
#include <span>
#include <vector>

namespace dicot::app {

struct ChosenCameras
{
    const SeenCamera* left = nullptr;
    const SeenCamera* right = nullptr;
};

/// Fault::kUnavailable: a camera is not there, has a problem, or its serial number stands for two; the sentence says
/// what is there instead. Points into `seen`.
Result<ChosenCameras> choose_cameras(const CamerasConfig& config, std::span<const SeenCamera> seen);

/// `driver` as in CamerasConfig.
bool opens_through_kernel(const SeenCamera& camera, const std::string& driver) noexcept;

/// The modes of the configured size, in its order of formats, then of rates from the configured one downwards.
/// Fault::kConfig: there is none; the sentence names what the camera has.
Result<std::vector<StreamOffer>> offers_for(const CamerasConfig& config, const Camera& camera);

/// Bytes of a frame of the configured size in the largest of its formats; a JPEG may be as large as YUYV.
std::size_t largest_frame(const CamerasConfig& config) noexcept;

} // namespace dicot::app
