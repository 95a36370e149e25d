// Transfers in flight and the frames that come out of them.
#pragma once

#include "frame_ring.h"
#include "usb_port.h"

#include "dicot/base/arena.h"
#include "dicot/uvc_parse/payload.h"

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>

namespace dicot {

/// Transfers and their buffers are made once. Completions arrive in the session's thread, which puts the payloads
/// together, publishes frames and sends the transfer off again; begin() and end() belong to the reader's thread.
class UvcStream
{
public:
    static constexpr int kTransfers = 8;
    static constexpr int kMostPackets = 32; ///< of one isochronous transfer: 4 ms at high speed
    static constexpr std::size_t kMostIsoBytes =
        std::size_t{512} * 1024; ///< of one transfer; reached at SuperSpeed only
    static constexpr std::size_t kMostBulkBytes = std::size_t{64} * 1024;
    static constexpr int kEndMs = 2000; ///< how long end() waits for cancelled transfers

    enum class Trouble : std::uint8_t
    {
        kNone,
        kGone,    ///< the device was unplugged
        kStalled, ///< the endpoint halted
        kFailing, ///< no transfer succeeds any more
    };

    struct Plan
    {
        UvcAlternate setting;
        std::size_t payload_bytes = 0; ///< as negotiated
        std::int64_t packet_us = 125;  ///< between two isochronous packets
        PayloadRules rules;
        CameraMode mode;
    };

    explicit UvcStream(FrameRing& ring) noexcept : ring_(ring) {}
    UvcStream(const UvcStream&) = delete;
    UvcStream& operator=(const UvcStream&) = delete;
    ~UvcStream();

    /// Bytes of the transfers' buffers that `device` can ever need.
    static std::size_t buffer_bytes(const UvcDevice& device) noexcept;
    /// Makes the transfers; `memory` is buffer_bytes() long.
    Status make(std::span<std::byte> memory) noexcept;

    /// Sends all transfers off. Fault::kTryAgain: the bus has no bandwidth for them (ENOSPC), or no memory.
    Status begin(UsbPort& port, const Plan& plan) noexcept;
    /// Cancels them and waits until all are back. Fault::kOsError: some did not come back in time; then neither their
    /// buffers nor this object may go away.
    Status end() noexcept;

    bool running() const noexcept { return running_; }
    Trouble trouble() noexcept;
    /// Transfers that the kernel still has.
    int in_flight() noexcept;

private:
    static void LIBUSB_CALL on_done(libusb_transfer* transfer) noexcept;
    void done(libusb_transfer& transfer) noexcept;
    void fill(libusb_transfer& transfer, UsbPort& port, const Plan& plan, std::size_t index) noexcept;
    void take_packets(libusb_transfer& transfer, std::int64_t now_us) noexcept;
    void take_bulk(libusb_transfer& transfer, std::int64_t now_us) noexcept;
    void feed(std::span<const std::byte> bytes, bool last, std::int64_t arrival_us) noexcept;
    void hand_over() noexcept;
    void give_up_frame() noexcept;
    void retire(Trouble trouble) noexcept;

    FrameRing& ring_;
    std::array<libusb_transfer*, kTransfers> transfers_{};
    std::span<std::byte> memory_;
    std::size_t transfer_room_ = 0;
    bool running_ = false;

    // The session's thread alone, between begin() and end().
    FrameAssembler assembler_;
    int slot_ = -1;
    std::int64_t packet_us_ = 125;

    std::mutex mutex_;
    std::condition_variable landed_;
    int in_flight_ = 0;
    int failures_ = 0; ///< in a row
    bool stopping_ = false;
    Trouble trouble_ = Trouble::kNone;
};

} // namespace dicot
