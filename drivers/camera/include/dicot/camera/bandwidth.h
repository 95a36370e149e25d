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
    kSuper, ///< 5 Gbit/s: 125 us bus intervals
};

/// An alternate setting of a streaming interface: what it may reserve.
struct AlternateSetting
{
    std::uint8_t number = 0;
    std::uint32_t bytes_per_interval = 0; ///< wMaxPacketSize x transactions of one (micro)frame
    std::uint32_t intervals_apart = 1;    ///< 2^(bInterval - 1)
};

/// A mode, and what the device asked for it.
struct StreamOffer
{
    CameraMode mode;
    /// dwMaxPayloadTransferSize of the device's answer to a probe (UVC 1.5, table 4-75); 0: nobody asked it.
    std::uint32_t payload_bytes = 0;
};

/// A camera as the planner sees it.
struct BusUser
{
    /// Cameras of one number and one speed share a wire: the host controller's bus, or, for full-speed cameras behind a
    /// high-speed hub, its transaction translator. Negative: no shared wire (replay, a camera of the board).
    int bus = -1;
    UsbSpeed speed = UsbSpeed::kHigh;
    bool bulk = false; ///< reserves nothing, but its bytes have to pass
    /// The driver may take a smaller alternate setting than the device asked for (libusb does, the kernel does not).
    bool chooses_alternate = false;
    std::span<const AlternateSetting> settings; ///< empty: not known, the estimate stands for the reservation
    std::span<const StreamOffer> offers;        ///< candidates in order of preference
};

/// What one camera is told to do.
struct PlannedStream
{
    CameraMode mode;
    std::uint8_t alternate = 0; ///< 0: bulk, or not known
    std::uint64_t reserved_bytes_per_s = 0;
    /// What it takes of one (micro)frame, protocol and bit stuffing included, in byte times of bus_budget().
    std::uint32_t bus_time = 0;
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
    char why[320] = {}; ///< one sentence for a person
};

/// Bytes of one (micro)frame that a stream of this mode fills: its bytes evenly over the time and 12 bytes of payload
/// header. A frame of MJPEG is taken for a quarter of the same picture in YUYV, 4 bits a pixel: webcams compress to a
/// sixth and less, leaves and gravel are the exception.
std::uint32_t estimated_payload(const CameraMode& mode, UsbSpeed speed) noexcept;

/// Byte times of one (micro)frame that streams may take. 80 % of 7500 at high speed and 90 % of 1500 at full speed may
/// be reserved (USB 2.0, 5.5.4, 5.6.4), 90 % of 62500 at super speed; bulk cameras are held to the same.
std::uint32_t bus_budget(UsbSpeed speed) noexcept;

/// Byte times that `bytes` of one (micro)frame cost: bit stuffing at its worst, 7/6 (USB 2.0, 5.11.3: hosts reserve
/// so), and the protocol of each transaction: 38 bytes at high speed (table 5-5), 9 at full speed (table 5-4), 55 and
/// 13 with bulk (tables 5-10, 5-9); 32 bytes a packet and no stuffing at super speed.
std::uint32_t bus_time(std::uint32_t bytes, UsbSpeed speed, bool bulk) noexcept;

/// The first pair of modes of the same format and size that fits, going down one ladder: the preferred format at its
/// rate, lower rates, smaller alternate settings that still carry the estimated stream, the next format or size, and at
/// last one camera after the other, down the same ladder.
///
/// The preferred rate of a format and size is that of its first offer; faster offers behind it are not used. The right
/// camera takes the fastest of its rates that is not above the left's, and the left one goes down to meet it (1 % is no
/// difference).
///
/// `refused` counts how often the bus has answered that it is full (ENOSPC) although a plan fitted: each time the next
/// plan is taken that asks for less bus time in all than the one before, where one camera after the other counts as the
/// greater of the two. Pure and bounded: it walks through all pairs of offers and settings at most twice.
BandwidthPlan plan_bandwidth(const BusUser& left, const BusUser& right, int refused) noexcept;

} // namespace dicot
