// Picture Transfer Protocol with Microsoft's extension for media, the device's side, for reading alone.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/mtp/codes.h"
#include "dicot/mtp/data_writer.h"
#include "dicot/mtp/device_link.h"
#include "dicot/mtp/exchange.h"
#include "dicot/mtp/object_source.h"
#include "dicot/mtp/snapshot_bytes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
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
    std::uint64_t sessions = 0, requests = 0, refused = 0, cancelled = 0, bytes_sent = 0;
    std::uint64_t objects_sent = 0; ///< times that a file's end was sent, whole or in parts
    std::uint64_t marked = 0;
    bool session_open = false;
};

/// One request after the other, as ISO 15740 and MTP 1.0 have them. `room`: what data passes through, kRoomBytes;
/// nothing else is taken. Whatever the host sends, it answers with a response code and goes on; there is no operation
/// that writes, deletes, moves or renames an object. README.md has the operations.
class Responder
{
public:
    static constexpr std::size_t kRoomBytes = Exchange::kRoomBytes;
    /// So long an idle host is waited for before what came and went is looked for.
    static constexpr int kIdleMs = 1000;
    /// Events of one look; what is beyond is told by one StorageInfoChanged.
    static constexpr int kMostEvents = 64;
    /// More objects than that are not told in one property list: the source may need longer for the first byte of it
    /// than hosts wait (libmtp: 20 s). They ask folder by folder then.
    static constexpr int kMostListed = 40'000;

    Responder(ObjectSource& objects, DeviceLink& link, const DeviceWords& words, std::span<std::byte> room) noexcept;

    /// Waits for one request and answers it, or for kIdleMs; also looks for what came and went, and posts events of it.
    /// Fault::kUnavailable: the host is gone (call again once there is one). Nothing else ends it.
    Status serve_one();
    /// The host is gone or reset us: session closed, request forgotten.
    void forget() noexcept;

    const ResponderCounts& counts() const noexcept { return counts_; }

private:
    struct Reply
    {
        std::uint16_t code = response::kOk; ///< 0: the host gets none
        std::optional<std::uint32_t> parameter;
    };
    using Answer = Reply (Responder::*)(const Block&);
    struct Operation
    {
        std::uint16_t code;
        Answer answer;
    };
    static std::span<const Operation> operations() noexcept;

    Reply answer(const Block& command);
    Reply refuse(const Block& command);
    void serve(const Block& command);
    void tell_changes();

    Reply get_device_info(const Block& command);
    Reply open_session(const Block& command);
    Reply close_session(const Block& command);
    Reply reset_device(const Block& command);
    Reply get_device_property(const Block& command);
    Reply describe_device_property(const Block& command);
    Reply get_storage_ids(const Block& command);
    Reply get_storage_info(const Block& command);

    Reply count_objects(const Block& command);
    Reply get_handles(const Block& command);
    Reply get_object_info(const Block& command);
    Reply get_object(const Block& command);
    Reply get_thumb(const Block& command);
    Reply get_part(const Block& command);
    Reply get_part_64(const Block& command);
    Reply get_references(const Block& command);

    Reply get_supported_properties(const Block& command);
    Reply describe_property(const Block& command);
    Reply get_property(const Block& command);
    Reply list_properties(const Block& command);

    Reply list_snapshots(const Block& command);
    Reply mark_pulled(const Block& command);
    Reply offer_time(const Block& command);

    struct Selection;
    static std::uint16_t code_of(const Status& status) noexcept;
    Reply send_data(std::uint64_t bytes, FunctionRef<Status(DataWriter&)> write);
    Reply send_dataset(FunctionRef<Status(DataWriter&)> write);
    Reply send_part(const Object& object, std::uint64_t offset, std::uint64_t most_bytes);
    Result<Object> find_file(Handle handle);
    std::uint16_t check(const Selection& selection);
    Status each_handle(const Selection& selection, FunctionRef<bool(Handle)> visit);
    bool objects_fit_one_list();
    Status each_listed(const Block& command, FunctionRef<bool(const Object&)> visit);
    void write_device_property(DataWriter& out, std::uint16_t property) noexcept;
    void write_property(DataWriter& out, std::uint16_t property, const Object& object) noexcept;

    ObjectSource& objects_;
    DeviceLink& link_;
    DeviceWords words_;
    Exchange exchange_;
    std::uint64_t persistent_half_; ///< tells this board's objects from those of others
    std::uint32_t session_ = 0;
    int requests_since_look_ = 0;
    ResponderCounts counts_;
    std::array<PulledNote, kMostPulledNotes> pulled_;
};

} // namespace dicot::mtp
