// What a virtual camera is: everything that its descriptors say.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace dicot::usbip {

enum class Pixels
{
    kYuyv,
    kMjpeg,
};

/// A frame size that a format offers.
struct Mode
{
    int width = 0;
    int height = 0;
    std::uint32_t largest_frame_bytes = 0; ///< what its largest frame takes
};

struct Format
{
    Pixels pixels = Pixels::kYuyv;
    std::vector<Mode> modes; ///< UVC numbers them from 1
};

/// What one alternate setting of the streaming interface reserves: wMaxPacketSize by its two parts.
struct Alternate
{
    int packet_bytes = 0;         ///< 1 .. 1024
    int packets_a_microframe = 1; ///< 1 .. 3
    int bytes_a_microframe() const { return packet_bytes * packets_a_microframe; }
};

/// What dwMaxPayloadTransferSize asks for.
enum class PayloadPolicy
{
    kFit,   ///< what the committed mode needs at its rate
    kMost,  ///< the largest alternate setting, whatever the mode: many real cameras do so for MJPEG
    kFixed, ///< `payload_bytes`
};

struct CameraModel
{
    std::string name = "left"; ///< in plans, commands and the log
    std::string product = "dicot virtual camera";
    std::string serial = "0001";
    std::uint16_t vendor_id = 0x1209; ///< the number that pid.codes keeps for tests
    std::uint16_t product_id = 0x0001;
    bool bulk = false;
    PayloadPolicy payload_policy = PayloadPolicy::kFit;
    int payload_bytes = 0;
    std::vector<int> rates_fps = {30, 15, 5};
    std::vector<Format> formats; ///< UVC numbers them from 1
    /// Ascending; setting k of the interface is element k - 1. Without meaning for bulk.
    std::vector<Alternate> alternates = {{192, 1}, {512, 1}, {1024, 1}, {800, 2}, {1024, 2}, {1024, 3}};
};

inline constexpr int kPayloadHeadBytes = 12;    ///< with time stamps, UVC 1.1 table 2-5
inline constexpr int kBulkPayloadBytes = 16384; ///< kFit and kMost
inline constexpr std::uint32_t kClockHz = 15'000'000;
inline constexpr int kControlInterface = 0;
inline constexpr int kStreamInterface = 1;
inline constexpr unsigned kVideoEndpoint = 1;
inline constexpr unsigned kStatusEndpoint = 2;
inline constexpr int kCameraTerminal = 1;
inline constexpr int kProcessingUnit = 2;
inline constexpr int kOutputTerminal = 3;

/// In units of 100 ns, as UVC counts; rounded.
inline std::uint32_t interval_of(int rate_fps)
{
    return static_cast<std::uint32_t>((10'000'000 + rate_fps / 2) / rate_fps);
}

} // namespace dicot::usbip
