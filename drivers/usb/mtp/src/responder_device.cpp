// What the host asks of the device as a whole: session, descriptions, storage.
#include "dicot/mtp/datasets.h"
#include "dicot/mtp/responder.h"

#include <iterator>

namespace dicot::mtp {
namespace {

constexpr std::uint16_t kEvents[] = {event::kObjectAdded, event::kObjectRemoved, event::kStorageInfoChanged};
constexpr std::uint16_t kDeviceProperties[] = {device_property::kFriendlyName, device_property::kPerceivedDeviceType};
constexpr std::uint16_t kFormats[] = {format::kUndefined, format::kAssociation, format::kExifJpeg, format::kPng};
constexpr std::uint32_t kStillCamera = 1; ///< MTP 1.0, perceived device type

std::uint16_t type_of(std::uint16_t property) noexcept
{
    return property == device_property::kFriendlyName ? data_type::kText : data_type::kU32;
}

bool is_device_property(std::uint32_t property) noexcept
{
    return property == device_property::kFriendlyName || property == device_property::kPerceivedDeviceType;
}

} // namespace

std::span<const Responder::Operation> Responder::operations() noexcept
{
    static constexpr Operation kOperations[] = {
        {operation::kGetDeviceInfo, &Responder::get_device_info},
        {operation::kOpenSession, &Responder::open_session},
        {operation::kCloseSession, &Responder::close_session},
        {operation::kGetStorageIds, &Responder::get_storage_ids},
        {operation::kGetStorageInfo, &Responder::get_storage_info},
        {operation::kGetNumObjects, &Responder::count_objects},
        {operation::kGetObjectHandles, &Responder::get_handles},
        {operation::kGetObjectInfo, &Responder::get_object_info},
        {operation::kGetObject, &Responder::get_object},
        {operation::kGetThumb, &Responder::get_thumb},
        {operation::kResetDevice, &Responder::reset_device},
        {operation::kGetDevicePropDesc, &Responder::describe_device_property},
        {operation::kGetDevicePropValue, &Responder::get_device_property},
        {operation::kGetPartialObject, &Responder::get_part},
        {operation::kGetPartialObject64, &Responder::get_part_64},
        {operation::kGetObjectPropsSupported, &Responder::get_supported_properties},
        {operation::kGetObjectPropDesc, &Responder::describe_property},
        {operation::kGetObjectPropValue, &Responder::get_property},
        {operation::kGetObjectPropList, &Responder::list_properties},
        {operation::kGetObjectReferences, &Responder::get_references},
        {operation::kListSnapshots, &Responder::list_snapshots},
        {operation::kMarkPulled, &Responder::mark_pulled},
        {operation::kOfferTime, &Responder::offer_time},
    };
    return kOperations;
}

Responder::Reply Responder::get_device_info(const Block&)
{
    DeviceInfo info;
    info.standard_version = kProtocolVersion;
    info.extension = kMicrosoftExtension;
    info.extension_version = kProtocolVersion;
    info.extension_words = kExtensionWords;
    for (const Operation& one : operations())
        info.operations.add(one.code);
    info.events = CodeList{kEvents};
    info.device_properties = CodeList{kDeviceProperties};
    info.formats = CodeList{kFormats};
    info.manufacturer = words_.manufacturer.view();
    info.model = words_.model.view();
    info.version = words_.version.view();
    info.serial = words_.serial.view();
    return send_dataset([&](DataWriter& out) {
        write(out, info);
        return Status{};
    });
}

Responder::Reply Responder::open_session(const Block& command)
{
    if (session_ != 0)
        return {response::kSessionAlreadyOpen, session_};
    if (command.parameters[0] == 0)
        return {response::kInvalidParameter, {}};
    session_ = command.parameters[0];
    counts_.session_open = true;
    ++counts_.sessions;
    tell_changes();
    return {};
}

Responder::Reply Responder::close_session(const Block&)
{
    session_ = 0;
    counts_.session_open = false;
    return {};
}

Responder::Reply Responder::reset_device(const Block& command)
{
    return close_session(command);
}

void Responder::write_device_property(DataWriter& out, std::uint16_t property) noexcept
{
    if (property == device_property::kFriendlyName)
        out.text(words_.name.view());
    else
        out.u32(kStillCamera);
}

Responder::Reply Responder::get_device_property(const Block& command)
{
    const std::uint32_t property = command.parameters[0];
    if (!is_device_property(property))
        return {response::kDevicePropNotSupported, {}};
    return send_dataset([&](DataWriter& out) {
        write_device_property(out, static_cast<std::uint16_t>(property));
        return Status{};
    });
}

Responder::Reply Responder::describe_device_property(const Block& command)
{
    if (!is_device_property(command.parameters[0]))
        return {response::kDevicePropNotSupported, {}};
    const auto property = static_cast<std::uint16_t>(command.parameters[0]);
    return send_dataset([&](DataWriter& out) {
        out.u16(property);
        out.u16(type_of(property));
        out.u8(0);                            // to be read only
        write_device_property(out, property); // from the factory
        write_device_property(out, property); // now
        out.u8(0);                            // of no special form
        return Status{};
    });
}

Responder::Reply Responder::get_storage_ids(const Block&)
{
    return send_dataset([&](DataWriter& out) {
        out.u32(1);
        out.u32(kStorage);
        return Status{};
    });
}

Responder::Reply Responder::get_storage_info(const Block& command)
{
    if (command.parameters[0] != kStorage)
        return {response::kInvalidStorageId, {}};
    const Result<Shelf> shelf = objects_.shelf();
    if (!shelf.ok())
        return {response::kGeneralError, {}};
    StorageInfo info;
    info.total_bytes = shelf.value().total_bytes;
    info.free_bytes = shelf.value().free_bytes;
    info.description = shelf.value().label.view();
    info.label = shelf.value().label.view();
    return send_dataset([&](DataWriter& out) {
        write(out, info);
        return Status{};
    });
}

} // namespace dicot::mtp
