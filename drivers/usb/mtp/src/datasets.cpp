#include "dicot/mtp/datasets.h"

#include <algorithm>

namespace dicot::mtp {
namespace {

CodeList read_codes(DataReader& in) noexcept
{
    CodeList list;
    for (std::uint32_t left = in.count(2); left > 0; --left)
        list.add(in.u16());
    return list;
}

} // namespace

bool CodeList::has(std::uint16_t code) const noexcept
{
    const auto codes = view();
    return std::find(codes.begin(), codes.end(), code) != codes.end();
}

std::optional<DeviceInfo> read_device_info(std::span<const std::byte> data) noexcept
{
    DataReader in{data};
    std::optional<DeviceInfo> info{std::in_place};
    info->standard_version = in.u16();
    info->extension = in.u32();
    info->extension_version = in.u16();
    info->extension_words = in.text<255>();
    info->functional_mode = in.u16();
    for (CodeList* list :
         {&info->operations, &info->events, &info->device_properties, &info->capture_formats, &info->formats})
        *list = read_codes(in);
    for (ShortText<255>* text : {&info->manufacturer, &info->model, &info->version, &info->serial})
        *text = in.text<255>();
    if (!in.ok())
        info.reset();
    return info;
}

void write(DataWriter& out, const DeviceInfo& info) noexcept
{
    out.u16(info.standard_version);
    out.u32(info.extension);
    out.u16(info.extension_version);
    out.text(info.extension_words.view());
    out.u16(info.functional_mode);
    for (const CodeList* list :
         {&info.operations, &info.events, &info.device_properties, &info.capture_formats, &info.formats})
        out.codes(list->view());
    for (const ShortText<255>* text : {&info.manufacturer, &info.model, &info.version, &info.serial})
        out.text(text->view());
}

std::optional<StorageInfo> read_storage_info(std::span<const std::byte> data) noexcept
{
    DataReader in{data};
    StorageInfo info;
    info.type = static_cast<StorageType>(in.u16());
    info.file_system = in.u16();
    info.access = in.u16();
    info.total_bytes = in.u64();
    info.free_bytes = in.u64();
    info.free_pictures = in.u32();
    info.description = in.text<255>();
    info.label = in.text<255>();
    return in.ok() ? std::optional{info} : std::nullopt;
}

void write(DataWriter& out, const StorageInfo& info) noexcept
{
    out.u16(static_cast<std::uint16_t>(info.type));
    out.u16(info.file_system);
    out.u16(info.access);
    out.u64(info.total_bytes);
    out.u64(info.free_bytes);
    out.u32(info.free_pictures);
    out.text(info.description.view());
    out.text(info.label.view());
}

std::optional<ObjectInfo> read_object_info(std::span<const std::byte> data) noexcept
{
    DataReader in{data};
    ObjectInfo info;
    info.storage = in.u32();
    info.format = in.u16();
    info.protection = in.u16();
    info.size = in.u32();
    in.bytes(2 + 6 * 4); // thumbnail: format, size, width, height; picture: width, height, depth
    info.parent = in.u32();
    info.association = in.u16();
    in.bytes(2 * 4); // what the association is for, and its place in a row
    info.name = in.text<255>();
    info.made = in.text<31>();
    info.changed = in.text<31>();
    in.text<31>(); // keywords
    return in.ok() ? std::optional{info} : std::nullopt;
}

void write(DataWriter& out, const ObjectInfo& info) noexcept
{
    out.u32(info.storage);
    out.u16(info.format);
    out.u16(info.protection);
    out.u32(info.size);
    out.u16(0);
    for (int i = 0; i < 6; ++i)
        out.u32(0);
    out.u32(info.parent);
    out.u16(info.association);
    out.u32(0);
    out.u32(0);
    out.text(info.name.view());
    out.text(info.made.view());
    out.text(info.changed.view());
    out.text({});
}

} // namespace dicot::mtp
