// The responder's side of the cable: two bulk endpoints, one for events, and what the host asks beside them.
#pragma once

#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot::mtp {

/// All calls from one thread. None takes memory from the heap.
///
/// One transaction: receive() brings a command, begin_transaction(), data one way or the other or none, send() of the
/// response, end_transaction(). Only end_transaction() and begin_transaction() clear what interrupted() tells.
class DeviceLink
{
public:
    /// Calls of send() whose bytes may be under way at once.
    static constexpr int kMostUnderWay = 2;

    virtual ~DeviceLink() = default;

    /// The host's next bytes: up to into.size() (a multiple of 512), fewer where its transfer ended with a short
    /// packet; 0: a packet of none. `patience_ms` < 0: as long as the host is there; run out, Fault::kTryAgain with
    /// nothing lost. Fault::kUnavailable: no host any more (unplugged, deconfigured, suspended for good), or
    /// an end was asked for; kIoError: the transfer was cancelled, or the host reset us (take_reset() tells).
    virtual Result<std::size_t> receive(std::span<std::byte> into, int patience_ms) = 0;
    /// A part of what goes to the host; all parts but the last are a multiple of 512 bytes. `last` ends the transfer:
    /// with a short packet, or with one of none where the whole transfer is a multiple of the packet size. May return
    /// before the host has it all: the bytes stay as they are until kMostUnderWay more calls have returned. So a caller
    /// that takes three pieces of memory in turn fills one while two are under way. Returns at once while fewer than
    /// kMostUnderWay are under way, also if the host does not read. Faults as of receive(); they may belong to an
    /// earlier call, and nothing is under way any more after one.
    virtual Status send(std::span<const std::byte> bytes, bool last) = 0;
    /// One event container, copied. Never waits: dropped (and counted by the link) while the host does not read.
    virtual void post_event(std::span<const std::byte> container) = 0;
    /// The host cancelled the transaction under way, or reset us, since begin_transaction(): answer nothing.
    virtual bool interrupted() const = 0;
    /// From here to end_transaction() the link tells the host "busy" where it asks for the status.
    virtual void begin_transaction(std::uint32_t id) = 0;
    /// Does not wait until the host has the response.
    virtual void end_transaction() = 0;
    /// The host reset us since the last call: the responder forgets its session.
    virtual bool take_reset() = 0;
};

} // namespace dicot::mtp
