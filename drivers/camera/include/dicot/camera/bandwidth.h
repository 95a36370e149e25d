// Whether two cameras fit on their buses, before either is asked to stream.
#pragma once

#include "dicot/camera/mode.h"

#include <cstdint>
#include <span>

namespace dicot {

enum class UsbSpeed : std::uint8_t
{
    kFull,  ///< 12 Mbit/s: 1 ms frames
    kHigh,  ///< 480 Mbit/s: 125 us microframes
    kSuper, ///< 5 Gbit/s
};

/// An alternate setting of a streaming interface: what it may reserve.
struct AlternateSetting
{
    std::uint8_t number = 0;
    std::uint32_t bytes_per_interval = 0; ///< wMaxPacketSize x transactions of one (micro)frame
    std::uint32_t intervals_apart = 1;    ///< 2^(bInterval - 1)
};

/// A camera as the planner sees it.
struct BusUser
{
    int bus = 0; ///< cameras of one number share bandwidth (host controller and, behind a hub's translator, the hub)
    UsbSpeed speed = UsbSpeed::kHigh;
    bool bulk = false; ///< reserves nothing, takes what is left
    std::span<const AlternateSetting> settings;
    std::span<const CameraMode> modes; ///< candidates in order of preference
};

/// What one camera is told to do.
struct PlannedStream
{
    CameraMode mode;
    std::uint8_t alternate = 0;
    double reserved_bytes_per_s = 0;
};

enum class Together : std::uint8_t
{
    kAtOnce,
    kOneAfterTheOther, ///< only one of them may stream at a time
    kNotAtAll
};

struct BandwidthPlan
{
    Together together = Together::kNotAtAll;
    PlannedStream left, right;
    char why[240] = {}; ///< one sentence for a person
};

/// The first pair of modes of the same size and format that fits, going down the ladder: the preferred format at its
/// rate, lower rates, smaller alternate settings, the next format, and at last one camera after the other.
///
/// A host reserves at most 80 % of a high-speed microframe (6000 of 7500 bytes) and 90 % of a full-speed frame for
/// periodic transfers (USB 2.0, 5.5.4 and 5.6.4); an isochronous transaction of a high-speed device costs its bytes
/// and 38 bytes of protocol (USB 2.0, table 5-9). `refused` counts how often the bus has answered that it is full
/// (ENOSPC) although a plan fitted: each time the first plan below the last one is taken.
BandwidthPlan plan_bandwidth(const BusUser& left, const BusUser& right, int refused);

} // namespace dicot
