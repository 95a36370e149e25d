// Properties of objects, as MTP adds them.
#include "object_words.h"

#include "dicot/mtp/responder.h"

#include <algorithm>

namespace dicot::mtp {
namespace {

struct Property
{
    std::uint16_t code, type;
};
constexpr Property kProperties[] = {
    {object_property::kStorageId, data_type::kU32},        {object_property::kObjectFormat, data_type::kU16},
    {object_property::kProtectionStatus, data_type::kU16}, {object_property::kObjectSize, data_type::kU64},
    {object_property::kObjectFileName, data_type::kText},  {object_property::kDateCreated, data_type::kText},
    {object_property::kDateModified, data_type::kText},    {object_property::kParentObject, data_type::kU32},
    {object_property::kPersistentId, data_type::kU128},    {object_property::kName, data_type::kText},
};

const Property* property_of(std::uint32_t code) noexcept
{
    const auto* found = std::find_if(std::begin(kProperties), std::end(kProperties),
                                     [&](const Property& one) { return one.code == code; });
    return found == std::end(kProperties) ? nullptr : found;
}

bool is_format(std::uint32_t code) noexcept
{
    return code == format::kUndefined || code == format::kAssociation || code == format::kExifJpeg ||
           code == format::kPng;
}

void write_default(DataWriter& out, std::uint16_t type) noexcept
{
    switch (type) {
    case data_type::kU16:
        return out.u16(0);
    case data_type::kU32:
        return out.u32(0);
    case data_type::kU128:
        out.u64(0);
        [[fallthrough]];
    case data_type::kU64:
        return out.u64(0);
    default:
        return out.text({});
    }
}

/// What GetObjectPropList is asked for.
struct Listing
{
    std::uint32_t handle, format, property, group, depth;

    explicit Listing(const Block& command) noexcept
        : handle(command.parameters[0]), format(command.parameters[1]), property(command.parameters[2]),
          group(command.parameters[3]), depth(command.parameters[4])
    {
        // Android's libraries ask for everything in this way; it is what the standard has as the next line.
        if (depth == kEvery && (handle == 0 || handle == kEvery)) {
            handle = kEvery;
            depth = 0;
        }
    }
    std::uint16_t wrong() const noexcept
    {
        if (property == 0)
            return group == 0 ? response::kParameterNotSupported : response::kSpecificationByGroupUnsupported;
        if (property != kEvery && property_of(property) == nullptr)
            return response::kObjectPropNotSupported;
        if (depth > 1)
            return response::kSpecificationByDepthUnsupported;
        return format == 0 || is_format(format) ? response::kOk : response::kInvalidObjectFormatCode;
    }
};

} // namespace

void Responder::write_property(DataWriter& out, std::uint16_t property, const Object& object) noexcept
{
    switch (property) {
    case object_property::kStorageId:
        return out.u32(kStorage);
    case object_property::kObjectFormat:
        return out.u16(format_of(object));
    case object_property::kProtectionStatus:
        return out.u16(kReadOnly);
    case object_property::kObjectSize:
        return out.u64(object.folder ? 0 : object.bytes);
    case object_property::kDateCreated:
    case object_property::kDateModified:
        return out.date(object.made_us);
    case object_property::kParentObject:
        return out.u32(object.parent);
    case object_property::kPersistentId:
        out.u64(object.handle);
        return out.u64(persistent_half_);
    default:
        return out.text(object.name.view());
    }
}

Responder::Reply Responder::get_supported_properties(const Block& command)
{
    if (!is_format(command.parameters[0]))
        return {response::kInvalidObjectFormatCode, {}};
    return send_dataset([&](DataWriter& out) {
        out.u32(static_cast<std::uint32_t>(std::size(kProperties)));
        for (const Property& one : kProperties)
            out.u16(one.code);
        return Status{};
    });
}

Responder::Reply Responder::describe_property(const Block& command)
{
    const Property* property = property_of(command.parameters[0]);
    if (property == nullptr)
        return {response::kInvalidObjectPropCode, {}};
    if (!is_format(command.parameters[1]))
        return {response::kInvalidObjectFormatCode, {}};
    return send_dataset([&](DataWriter& out) {
        out.u16(property->code);
        out.u16(property->type);
        out.u8(0); // to be read only
        write_default(out, property->type);
        out.u32(0); // of no group
        out.u8(0);  // of no special form
        return Status{};
    });
}

Responder::Reply Responder::get_property(const Block& command)
{
    const Result<Object> object = objects_.find(command.parameters[0]);
    if (!object.ok())
        return {code_of(object.status()), {}};
    const Property* property = property_of(command.parameters[1]);
    if (property == nullptr)
        return {response::kObjectPropNotSupported, {}};
    return send_dataset([&](DataWriter& out) {
        write_property(out, property->code, object.value());
        return Status{};
    });
}

Status Responder::each_listed(const Block& command, FunctionRef<bool(const Object&)> visit)
{
    const Listing listing{command};
    const auto look = [&](Handle handle) {
        if (!exchange_.fault().ok())
            return false;
        const Result<Object> object = objects_.find(handle);
        // What went between the list and this look is no longer listed.
        if (!object.ok() || (listing.format != 0 && format_of(object.value()) != listing.format))
            return true;
        return visit(object.value());
    };
    if (listing.handle == kEvery)
        return objects_.all(look);
    if (listing.handle != 0) {
        const Object object = TRY(objects_.find(listing.handle));
        if (!look(object.handle) || listing.depth == 0 || !object.folder)
            return {};
    }
    return objects_.children(listing.handle, look);
}

bool Responder::objects_fit_one_list()
{
    int count = 0;
    const Status counted = objects_.all([&](Handle) { return exchange_.fault().ok() && ++count <= kMostListed; });
    return counted.ok() && count <= kMostListed;
}

Responder::Reply Responder::list_properties(const Block& command)
{
    tell_changes();
    const Listing listing{command};
    if (const std::uint16_t wrong = listing.wrong(); wrong != response::kOk)
        return {wrong, {}};
    if (listing.handle == kEvery && !objects_fit_one_list())
        return {response::kSpecificationByDepthUnsupported, {}};
    const auto write_object = [&](DataWriter& out, const Object& object) {
        std::uint32_t count = 0;
        for (const Property& one : kProperties) {
            if (listing.property != kEvery && listing.property != one.code)
                continue;
            out.u32(object.handle);
            out.u16(one.code);
            out.u16(one.type);
            write_property(out, one.code, object);
            ++count;
        }
        return count;
    };
    CountSink sink;
    DataWriter counted{sink};
    std::uint32_t count = 0;
    const Status status = each_listed(command, [&](const Object& object) {
        count += write_object(counted, object);
        return true;
    });
    if (!status.ok())
        return {code_of(status), {}};
    return send_data(4 + sink.count(), [&](DataWriter& out) {
        out.u32(count);
        return each_listed(command, [&](const Object& object) {
            write_object(out, object);
            return out.status().ok();
        });
    });
}

} // namespace dicot::mtp
