// Probe and commit: what host and camera agree on before a stream begins.
#pragma once

#include "usb_port.h"

#include "dicot/uvc_parse/stream_control.h"

#include <cstdint>

namespace dicot {

struct Agreement
{
    StreamControl control;
    UvcAlternate setting;
};

/// UVC 1.5, 4.3.1.1. `alternate` 0 takes the smallest setting that fits the payloads; another number asks the camera to
/// make them fit that one. Fault::kTryAgain: the camera refuses, or its payloads do not fit. Fault::kUnavailable: it
/// has no such mode, or is gone.
Result<Agreement> agree(UsbPort& port, const UvcDevice& device, const CameraMode& mode,
                        std::uint8_t alternate) noexcept;

/// What the camera would agree to for this mode; nothing is committed. Faults as for agree().
Result<StreamControl> ask_mode(UsbPort& port, const UvcDevice& device, const CameraMode& mode) noexcept;

} // namespace dicot
