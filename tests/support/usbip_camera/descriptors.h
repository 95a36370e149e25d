// What a virtual camera answers to GET_DESCRIPTOR. UVC 1.1, high speed.
#pragma once

#include "model.h"
#include "wire.h"

#include <string_view>

namespace dicot::usbip {

/// 18 bytes, USB 2.0 table 9-8.
Bytes device_descriptor(const CameraModel& camera);

/// The configuration with all that follows it: interfaces, class-specific parts, endpoints, alternate settings.
Bytes configuration_descriptor(const CameraModel& camera);

/// `index` 0: the languages; 1 maker, 2 product, 3 serial; empty for others. Text is UTF-8 up to U+FFFF; at most 126
/// characters fit.
Bytes string_descriptor(const CameraModel& camera, int index);

} // namespace dicot::usbip
