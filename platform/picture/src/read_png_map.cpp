#include "decode.h"
#include "decode_map.h"
#include "dicot/os/shown_path.h"
#include "png_reader.h"

#include <bit>
#include <cstring>
#include <limits>

namespace dicot {
namespace {

/// The row's raw samples lie at the end of its floats, so that each float overwrites only samples already used.
void spread(const std::byte* raw, int bytes, double scale, std::span<float> row) noexcept
{
    for (float& out : row) {
        std::uint16_t value = 0;
        if (bytes == 2)
            std::memcpy(&value, raw, sizeof value);
        else
            value = std::to_integer<std::uint16_t>(*raw);
        raw += bytes;
        out = value == 0 ? std::numeric_limits<float>::infinity() : static_cast<float>(value / scale);
    }
}

void read_values(PngReader& reader, const MapRequest& request, int bytes)
{
    const ImageView<float>& into = *request.into;
    const auto width = static_cast<std::size_t>(into.width);
    if (png_get_interlace_type(reader.png, reader.info) != PNG_INTERLACE_NONE)
        leave(reader,
              failure(Fault::kBadData, "%s: the map is interlaced; save it without", shown_path(reader.source.name())));
    if (bytes == 2 && std::endian::native == std::endian::little)
        png_set_swap(reader.png);
    png_read_update_info(reader.png, reader.info);
    for (int y = 0; y < into.height; ++y) {
        const std::span<float> row{into.row(y), width};
        std::byte* const raw = std::as_writable_bytes(row).last(width * static_cast<std::size_t>(bytes)).data();
        png_read_row(reader.png, reinterpret_cast<png_bytep>(raw), nullptr);
        spread(raw, bytes, request.png_scale, row);
    }
    png_read_end(reader.png, nullptr);
}

void read_map_of(PngReader& reader, void* context)
{
    auto& request = *static_cast<MapRequest*>(context);
    const int bits = png_get_bit_depth(reader.png, reader.info);
    const bool grey = png_get_color_type(reader.png, reader.info) == PNG_COLOR_TYPE_GRAY;
    if (!grey || (bits != 8 && bits != 16))
        leave(reader, failure(Fault::kBadData, "%s: is no disparity map; give a PFM or a grey PNG of 8 or 16 bits",
                              shown_path(reader.source.name())));
    const Status fits = accept_head(reader.source.name(), png_get_image_width(reader.png, reader.info),
                                    png_get_image_height(reader.png, reader.info),
                                    bits == 16 ? MapKind::kPng16 : MapKind::kPng8, request);
    if (!fits.ok())
        leave(reader, fits);
    if (request.into != nullptr)
        read_values(reader, request, bits / 8);
}

} // namespace

Status decode_png_map(ByteSource& source, MapRequest& request) noexcept
{
    return read_png(source, &read_map_of, &request);
}

} // namespace dicot
