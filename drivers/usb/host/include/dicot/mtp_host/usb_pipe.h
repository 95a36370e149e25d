// The computer's side of the cable: what an MTP conversation needs of USB.
#pragma once

#include "dicot/base/status.h"
#include "dicot/mtp_host/mtp_list.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace dicot::mtp {

/// Every call ends within its patience and half a second. Faults: kUnavailable: the device is gone; kTryAgain: nothing
/// went over within the patience; kIoError: the device refuses (halts the endpoint, sends more than a packet);
/// kOsError: this system has no memory for transfers; kUsage: a person asked for the end. All calls from one thread.
class UsbPipe
{
public:
    struct Piece
    {
        std::size_t bytes = 0;
        bool ended = false; ///< by a packet that is shorter than the others, or empty
    };

    virtual ~UsbPipe() = default;

    virtual std::size_t packet_bytes() const = 0;
    /// One whole transfer, with an empty packet behind it if it is a multiple of packet_bytes().
    virtual Status send(std::span<const std::byte> bytes, int patience_ms) = 0;
    /// What the device sends until its transfer ends or `into`, a multiple of packet_bytes(), is full; after the
    /// patience what came so far.
    virtual Result<Piece> receive(std::span<std::byte> into, int patience_ms) = 0;

    /// The requests of the class (USB still image 1.0, clause 5.2).
    virtual Status cancel(std::uint32_t transaction) = 0;
    virtual Status reset() = 0;
    /// Get Device Status: the response code in it.
    virtual Result<std::uint16_t> status() = 0;
    /// Both bulk endpoints begin anew.
    virtual void clear_halts() = 0;
};

/// Asks whether a person wants the end: from the thread that waits, five times a second.
using StopAsked = bool (*)();

/// Through libusb, which finds nothing by itself: the device file of `listed` is opened, the kernel's driver detached,
/// the interface claimed; all given back at the end. Fault::kUnavailable: it is gone, this user may not, or another
/// program (a file manager) has it; the sentence says which, and what to do.
Result<std::unique_ptr<UsbPipe>> open_usb_pipe(const MtpListed& listed, StopAsked stop);

} // namespace dicot::mtp
