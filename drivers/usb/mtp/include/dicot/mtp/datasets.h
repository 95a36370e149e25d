// The datasets of ISO 15740, clause 5.5, and MTP 1.0, clause 5, as both ends of the cable speak them.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/mtp/data_reader.h"
#include "dicot/mtp/data_writer.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace dicot::mtp {

/// As many as a device may name; what it names beyond is passed over.
class CodeList
{
public:
    static constexpr std::size_t kMost = 512;

    CodeList() noexcept = default;
    explicit CodeList(std::span<const std::uint16_t> codes) noexcept
    {
        for (const std::uint16_t code : codes)
            add(code);
    }

    void add(std::uint16_t code) noexcept
    {
        if (count_ < kMost)
            codes_[count_++] = code;
    }
    bool has(std::uint16_t code) const noexcept;
    std::span<const std::uint16_t> view() const noexcept { return {codes_.data(), count_}; }

private:
    std::array<std::uint16_t, kMost> codes_{};
    std::size_t count_ = 0;
};

struct DeviceInfo
{
    std::uint16_t standard_version = 0;
    std::uint32_t extension = 0; ///< whose; 6 is Microsoft's
    std::uint16_t extension_version = 0;
    ShortText<255> extension_words;
    std::uint16_t functional_mode = 0;
    CodeList operations, events, device_properties, capture_formats, formats;
    ShortText<255> manufacturer, model, version, serial;
};

enum class StorageType : std::uint16_t
{
    kFixedRom = 1,
    kRemovableRom = 2,
    kFixedRam = 3,
    kRemovableRam = 4,
};

struct StorageInfo
{
    StorageType type = StorageType::kFixedRom;
    std::uint16_t file_system = 2; ///< 2: generic hierarchical
    std::uint16_t access = 1;      ///< 0: read and write, 1: read, 2: read and delete
    std::uint64_t total_bytes = 0, free_bytes = 0;
    std::uint32_t free_pictures = 0xFFFFFFFF; ///< all ones: not told
    ShortText<255> description, label;
};

/// Whatever is 0 or empty here is not told.
struct ObjectInfo
{
    std::uint32_t storage = 0;
    std::uint16_t format = 0;
    std::uint16_t protection = 0;  ///< 1: read only
    std::uint32_t size = 0;        ///< bytes; all ones: 4 GiB or more, property DC04 has it
    std::uint32_t parent = 0;      ///< 0: at the top
    std::uint16_t association = 0; ///< 1: a generic folder
    ShortText<255> name;
    ShortText<31> made, changed; ///< parse_date()
};

// Datasets may be followed by bytes that later versions add: those are passed over. Empty: cut short.
std::optional<DeviceInfo> read_device_info(std::span<const std::byte> data) noexcept;
std::optional<StorageInfo> read_storage_info(std::span<const std::byte> data) noexcept;
std::optional<ObjectInfo> read_object_info(std::span<const std::byte> data) noexcept;

void write(DataWriter& out, const DeviceInfo& info) noexcept;
void write(DataWriter& out, const StorageInfo& info) noexcept;
void write(DataWriter& out, const ObjectInfo& info) noexcept;

/// Handles and storages: a count, then 32 bits each. `visit` gets each one; false: cut short.
template <typename Visit>
bool read_handles(std::span<const std::byte> data, Visit&& visit)
{
    DataReader in{data};
    for (std::uint32_t left = in.count(4); left > 0; --left)
        visit(in.u32());
    return in.ok();
}

} // namespace dicot::mtp
