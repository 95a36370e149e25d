// Which objects there are, what they are called, and what is in them.
#include "object_words.h"
#include "selection.h"

#include "dicot/base/utc_time.h"
#include "dicot/mtp/datasets.h"

#include <algorithm>

namespace dicot::mtp {
namespace {

constexpr std::uint16_t kFirstPicture = 0x3800, kLastPicture = 0x3FFF; ///< formats
constexpr std::uint16_t kGenericFolder = 1;                            ///< association type

bool is_wanted(std::uint32_t format, const Object& object) noexcept
{
    const std::uint16_t has = format_of(object);
    return format == kEvery ? has >= kFirstPicture && has <= kLastPicture : has == format;
}

} // namespace

std::uint16_t Responder::check(const Selection& selection)
{
    if (selection.storage != kStorage && selection.storage != kEvery)
        return response::kInvalidStorageId;
    if (selection.parent == kRoot || selection.parent == kTop)
        return response::kOk;
    const Result<Object> parent = objects_.find(selection.parent);
    if (!parent.ok())
        return code_of(parent.status());
    return parent.value().folder ? response::kOk : response::kInvalidParentObject;
}

Status Responder::each_handle(const Selection& selection, FunctionRef<bool(Handle)> visit)
{
    const auto chosen = [&](Handle handle) {
        if (!exchange_.fault().ok())
            return false;
        if (selection.format != 0) {
            const Result<Object> object = objects_.find(handle);
            if (!object.ok() || !is_wanted(selection.format, object.value()))
                return true;
        }
        return visit(handle);
    };
    if (selection.parent == kRoot)
        return objects_.all(chosen);
    return objects_.children(selection.parent == kTop ? kRoot : selection.parent, chosen);
}

Responder::Reply Responder::count_objects(const Block& command)
{
    tell_changes();
    const Selection selection{command};
    if (const std::uint16_t wrong = check(selection); wrong != response::kOk)
        return {wrong, {}};
    std::uint32_t count = 0;
    const Status counted = each_handle(selection, [&](Handle) {
        ++count;
        return true;
    });
    if (!counted.ok())
        return {code_of(counted), {}};
    return {response::kOk, count};
}

Responder::Reply Responder::get_handles(const Block& command)
{
    const Reply counted = count_objects(command);
    if (counted.code != response::kOk)
        return counted;
    const std::uint32_t count = counted.parameter.value_or(0);
    const Selection selection{command};
    const Reply reply = send_data(4 + 4 * std::uint64_t{count}, [&](DataWriter& out) {
        out.u32(count);
        return each_handle(selection, [&](Handle handle) {
            out.u32(handle);
            return out.status().ok();
        });
    });
    return reply;
}

Responder::Reply Responder::get_object_info(const Block& command)
{
    const Result<Object> found = objects_.find(command.parameters[0]);
    if (!found.ok())
        return {code_of(found.status()), {}};
    const Object& object = found.value();
    ObjectInfo info;
    info.storage = kStorage;
    info.format = format_of(object);
    info.protection = kReadOnly;
    if (!object.folder)
        info.size = static_cast<std::uint32_t>(std::min<std::uint64_t>(object.bytes, 0xFFFFFFFF));
    info.parent = object.parent;
    info.association = object.folder ? kGenericFolder : 0;
    info.name = object.name.view();
    info.made = utc_stamp(object.made_us).view();
    info.changed = info.made;
    return send_dataset([&](DataWriter& out) {
        write(out, info);
        return Status{};
    });
}

Result<Object> Responder::find_file(Handle handle)
{
    Object object = TRY(objects_.find(handle));
    if (object.folder)
        return failure(Fault::kNoInput, "%s is a folder", object.name.c_str());
    return object;
}

Responder::Reply Responder::send_part(const Object& object, std::uint64_t offset, std::uint64_t most_bytes)
{
    const std::uint64_t bytes = offset < object.bytes ? std::min(object.bytes - offset, most_bytes) : 0;
    exchange_.begin_data(bytes);
    Status status;
    for (std::uint64_t done = 0; done < bytes && status.ok();) {
        const std::span<std::byte> place = exchange_.place();
        std::size_t got = 0;
        status = objects_.read(object.handle, offset + done, place, got);
        got = std::min(got, place.size());
        if (status.ok() && got == 0)
            status = failure(Fault::kIoError, "%s is shorter than it was", object.name.c_str());
        // Nothing has left yet: the host gets the reason instead of data that end early.
        if (!status.ok() && exchange_.take_back())
            return {code_of(status), {}};
        if (status.ok())
            status = exchange_.filled(got);
        done += got;
    }
    if (!exchange_.end_data())
        return {response::kIncompleteTransfer, {}};
    if (offset + bytes == object.bytes && (bytes > 0 || object.bytes == 0))
        ++counts_.objects_sent;
    return {response::kOk, static_cast<std::uint32_t>(bytes)};
}

Responder::Reply Responder::get_object(const Block& command)
{
    const Result<Object> object = find_file(command.parameters[0]);
    if (!object.ok())
        return {code_of(object.status()), {}};
    Reply reply = send_part(object.value(), 0, object.value().bytes);
    reply.parameter.reset();
    return reply;
}

Responder::Reply Responder::get_thumb(const Block& command)
{
    const Result<Object> object = objects_.find(command.parameters[0]);
    return {object.ok() ? response::kNoThumbnailPresent : code_of(object.status()), {}};
}

Responder::Reply Responder::get_part(const Block& command)
{
    const Result<Object> object = find_file(command.parameters[0]);
    if (!object.ok())
        return {code_of(object.status()), {}};
    return send_part(object.value(), command.parameters[1], command.parameters[2]);
}

Responder::Reply Responder::get_part_64(const Block& command)
{
    const Result<Object> object = find_file(command.parameters[0]);
    if (!object.ok())
        return {code_of(object.status()), {}};
    const std::uint64_t offset = command.parameters[1] | std::uint64_t{command.parameters[2]} << 32;
    return send_part(object.value(), offset, command.parameters[3]);
}

Responder::Reply Responder::get_references(const Block& command)
{
    const Result<Object> object = objects_.find(command.parameters[0]);
    if (!object.ok())
        return {code_of(object.status()), {}};
    return send_dataset([&](DataWriter& out) {
        out.u32(0);
        return Status{};
    });
}

} // namespace dicot::mtp
