// Which decoder a file wants, by its first bytes.
#pragma once

#include "decode.h"

#include "dicot/os/shown_path.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>

namespace dicot {

template <typename Request>
struct Format
{
    std::string_view magic;
    Status (*decode)(ByteSource&, Request&) noexcept;
};

/// `if_empty` and `if_unknown` end the sentences for files without bytes and of no known format.
template <typename Request>
Status decode_by_magic(ByteSource& source, std::span<const Format<Request>> formats, Request& request,
                       const char* if_empty, const char* if_unknown) noexcept
{
    const std::span<const std::byte> front = source.ahead();
    if (!source.trouble().ok())
        return source.trouble();
    if (front.empty())
        return failure(Fault::kBadData, "%s: the file is empty; %s", shown_path(source.name()), if_empty);
    for (const Format<Request>& format : formats) {
        const std::size_t known = std::min(front.size(), format.magic.size());
        if (std::memcmp(front.data(), format.magic.data(), known) != 0)
            continue;
        return known == format.magic.size() ? format.decode(source, request) : ended_early(source);
    }
    return failure(Fault::kBadData, "%s: %s", shown_path(source.name()), if_unknown);
}

} // namespace dicot
