// The bytes in front of a cloud's points, as the Draco bitstream 2.3 specification lays them out.
#include "dicot/codec/decode_cloud.h"
#include "meta_entries.h"

#include "dicot/os/shown_path.h"

#include <cstdint>
#include <string_view>

namespace dicot {
namespace {

/// Reads front to back; once it has run past the end, everything it gives is zero and `broken()` says so.
class Bytes
{
public:
    explicit Bytes(std::span<const std::byte> bytes) : rest_(bytes) {}

    bool broken() const { return broken_; }
    std::size_t left() const { return rest_.size(); }
    std::uint8_t u8() { return static_cast<std::uint8_t>(little_endian(1)); }
    std::uint32_t little_endian(int count)
    {
        const std::string_view bytes = text(static_cast<std::size_t>(count));
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < bytes.size(); ++i)
            value |= std::uint32_t{static_cast<std::uint8_t>(bytes[i])} << (8 * i);
        return value;
    }
    std::uint32_t varint()
    {
        std::uint32_t value = 0;
        for (int shift = 0; shift < 32; shift += 7) {
            const std::uint8_t byte = u8();
            value |= std::uint32_t{byte & 0x7FU} << shift;
            if (byte < 0x80)
                return value;
        }
        broken_ = true;
        return 0;
    }
    std::string_view text(std::size_t count)
    {
        if (broken_ || count > rest_.size()) {
            broken_ = true;
            return {};
        }
        const std::string_view bytes{reinterpret_cast<const char*>(rest_.data()), count};
        rest_ = rest_.subspan(count);
        return bytes;
    }

private:
    std::span<const std::byte> rest_;
    bool broken_ = false;
};

constexpr std::string_view kMagic = "DRACO";
constexpr std::uint32_t kHasMetadata = 0x8000;
// Attribute type, data type, components, normalised, id: POSITION float32, COLOR uint8, GENERIC float32; of some
// GENERIC uint16.
constexpr std::uint8_t kAttributes[4][5] = {{0, 9, 3, 0, 0}, {2, 2, 3, 1, 1}, {4, 9, 1, 0, 2}, {4, 4, 1, 0, 3}};
// How each attribute is packed: quantised, integer, quantised, integer.
constexpr std::uint8_t kPackings[4] = {2, 1, 2, 1};
constexpr std::uint32_t kMostEntries = 64;

Status damaged(const char* name, const char* what)
{
    return failure(Fault::kBadData, "%s: the cloud file is damaged (%s): copy or make it again", shown_path(name),
                   what);
}

Status read_header(Bytes& bytes, const char* name)
{
    if (bytes.text(kMagic.size()) != kMagic)
        return failure(Fault::kBadData, "%s: not a cloud file (.drc): give a file that 'dicot process' wrote",
                       shown_path(name));
    const std::uint32_t version = bytes.u8() * 256U + bytes.u8();
    const std::uint8_t geometry = bytes.u8();
    const std::uint8_t method = bytes.u8();
    const std::uint32_t flags = bytes.little_endian(2);
    if (bytes.broken())
        return damaged(name, "it ends in its header");
    if (version != 0x0203 || geometry != 0 || method != 0 || flags != kHasMetadata)
        return failure(Fault::kBadData, "%s: a Draco file of another program: give a file that 'dicot process' wrote",
                       shown_path(name));
    return {};
}

bool is_named(Bytes& bytes, std::uint8_t id, std::string_view as)
{
    return bytes.varint() == id && bytes.varint() == 1 && bytes.text(bytes.u8()) == "name" &&
           bytes.text(bytes.varint()) == as && bytes.varint() == 0;
}

/// The attributes that have metadata, their names: confidence, and of some files leaf.
Status read_attribute_names(Bytes& bytes, const char* name, CloudOutline& outline)
{
    const std::uint32_t named = bytes.varint();
    outline.has_leaves = named == 2;
    const bool ours = (named == 1 || named == 2) && is_named(bytes, kAttributes[2][4], "confidence") &&
                      (named == 1 || is_named(bytes, kAttributes[3][4], "leaf"));
    return ours ? Status{} : damaged(name, "no attribute is named confidence");
}

Status read_entries(Bytes& bytes, const char* name, CloudOutline& outline)
{
    unsigned seen = 0;
    const std::uint32_t entries = bytes.varint();
    if (entries > kMostEntries)
        return damaged(name, "too much metadata");
    for (std::uint32_t i = 0; i < entries && !bytes.broken(); ++i) {
        const std::string_view key = bytes.text(bytes.u8());
        const std::string_view text = bytes.text(bytes.varint());
        const unsigned bit = grid_key(key);
        if (bytes.broken() || (seen & bit) != 0 || !take_entry(key, text, outline.meta, outline.grid))
            return damaged(name, "its metadata makes no sense");
        seen |= bit;
    }
    if (bytes.varint() != 0 || bytes.broken())
        return damaged(name, "its metadata makes no sense");
    if (seen != kSeenAll)
        return damaged(name, "unit or grid is missing in its metadata");
    return {};
}

bool read_attributes(Bytes& bytes, std::size_t count)
{
    if (bytes.u8() != 1 || bytes.varint() != count)
        return false;
    for (const auto& attribute : std::span(kAttributes).first(count))
        for (const std::uint8_t field : attribute)
            if (bytes.u8() != field)
                return false;
    for (const std::uint8_t packing : std::span(kPackings).first(count))
        if (bytes.u8() != packing)
            return false;
    return !bytes.broken();
}

} // namespace

Result<CloudOutline> outline_of(std::span<const std::byte> file, const char* name)
{
    if (file.size() > kMaxCloudFileBytes)
        return failure(Fault::kBadData,
                       "%s: %zu MiB are more than any cloud file has (%zu MiB): give a file that "
                       "'dicot process' wrote",
                       shown_path(name), file.size() >> 20, kMaxCloudFileBytes >> 20);
    Bytes bytes{file};
    CloudOutline outline;
    TRY(read_header(bytes, name));
    TRY(read_attribute_names(bytes, name, outline));
    TRY(read_entries(bytes, name, outline));
    outline.points = bytes.little_endian(4);
    if (outline.points < 1 || outline.points > kMaxCloudPoints)
        return damaged(name, "a senseless number of points");
    if (!read_attributes(bytes, outline.has_leaves ? 4 : 3))
        return damaged(name, "its attributes are not position, colour and confidence");
    outline.points_at = file.size() - bytes.left();
    return outline;
}

} // namespace dicot
