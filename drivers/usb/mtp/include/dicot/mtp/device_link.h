// The responder's side of the cable: two bulk endpoints, one for events, and what the host asks beside them.
#pragma once

#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot::mtp {

/// All calls from one thread. None takes memory from the heap.
class DeviceLink
{
public:
    virtual ~DeviceLink() = default;

    /// The host's next bytes: up to into.size() (a multiple of 512), fewer where its transfer ended with a short
    /// packet; 0: a packet of none. `patience_ms` < 0: as long as the host is there; run out, Fault::kTryAgain with
    /// nothing lost. Fault::kUnavailable: no host any more (unplugged, deconfigured, suspended for good), or
    /// an end was asked for; kIoError: the transfer was cancelled, or the host reset us (asks cancelled() and why).
    virtual Result<std::size_t> receive(std::span<std::byte> into, int patience_ms) = 0;
    /// A part of what goes to the host; all parts but the last are a multiple of 512 bytes. `last` ends the transfer
    /// with a short packet, or with one of none. May return before the host has it all; an error may come with the next
    /// call.
    virtual Status send(std::span<const std::byte> bytes, bool last) = 0;
    /// One event container. Never waits: dropped (and counted by the link) while the host does not read.
    virtual void post_event(std::span<const std::byte> container) = 0;
    /// The host cancelled the transaction under way, or reset us, since the last begin_transaction(): answer nothing.
    virtual bool interrupted() const = 0;
    virtual void begin_transaction(std::uint32_t id) = 0;
    virtual void end_transaction() = 0;
    /// The session ended by Device Reset Request: the responder forgets it.
    virtual bool take_reset() = 0;
};

} // namespace dicot::mtp
