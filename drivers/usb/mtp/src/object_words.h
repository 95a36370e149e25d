// An object as the protocol names it.
#pragma once

#include "dicot/mtp/codes.h"
#include "dicot/mtp/object_source.h"

#include <cstdint>

namespace dicot::mtp {

inline constexpr std::uint16_t kReadOnly = 0x0001; ///< protection status

inline std::uint16_t format_of(const Object& object) noexcept
{
    const std::string_view name = object.name.view();
    if (object.folder)
        return format::kAssociation;
    if (name.ends_with(".jpg"))
        return format::kExifJpeg;
    return name.ends_with(".png") ? format::kPng : format::kUndefined;
}

} // namespace dicot::mtp
