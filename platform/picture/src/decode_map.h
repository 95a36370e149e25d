// What the decoders of disparity maps have in common.
#pragma once

#include "byte_source.h"
#include "dicot/picture/read_map.h"

namespace dicot {

/// What a map decoder is asked for: the header alone, or the values too.
struct MapRequest
{
    const ImageView<float>* into = nullptr; ///< null: the header alone
    double png_scale = 1;
    MapHead head{}; ///< the answer
};

/// Notes what the header tells. Fails above the limits, and where `into` has another size.
Status accept_head(const char* name, std::uint64_t width, std::uint64_t height, MapKind kind,
                   MapRequest& request) noexcept;

/// Each reads from the first byte of the file; the caller has seen the format's magic.
Status decode_pfm(ByteSource& source, MapRequest& request) noexcept;
Status decode_png_map(ByteSource& source, MapRequest& request) noexcept;

} // namespace dicot
