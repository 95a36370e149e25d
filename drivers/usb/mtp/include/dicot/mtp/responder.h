// Picture Transfer Protocol with Microsoft's extension for media, the device's side, for reading alone.
#pragma once

#include "dicot/mtp/device_link.h"
#include "dicot/mtp/object_source.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot::mtp {

struct DeviceWords
{
    ShortText<63> manufacturer, model, version, serial;
    ShortText<63> name; ///< the board's, as people call it
};

/// What it did so far, for status and log.
struct ResponderCounts
{
    std::uint64_t sessions = 0, requests = 0, refused = 0, cancelled = 0, objects_sent = 0, bytes_sent = 0;
    std::uint64_t marked = 0;
    bool session_open = false;
};

/// One request after the other, as ISO 15740 and MTP 1.0 have them. `room`: what data passes through, kRoomBytes;
/// nothing else is taken. Whatever the host sends, it answers with a response code and goes on; there is no operation
/// that writes, deletes, moves or renames an object.
class Responder
{
public:
    static constexpr std::size_t kRoomBytes = std::size_t{512} << 10;

    Responder(ObjectSource& objects, DeviceLink& link, const DeviceWords& words, std::span<std::byte> room) noexcept;

    /// Waits for one request and answers it; also looks for what came and went, and posts events of it. Fault::
    /// kUnavailable: the host is gone (call again once there is one). Nothing else ends it.
    Status serve_one();
    /// The host is gone or reset us: session closed, request forgotten.
    void forget() noexcept;

    const ResponderCounts& counts() const noexcept { return counts_; }

private:
    ObjectSource& objects_;
    DeviceLink& link_;
    DeviceWords words_;
    std::span<std::byte> room_;
    ResponderCounts counts_;
};

} // namespace dicot::mtp
