// What the writers of the picture formats have in common.
#pragma once

#include "dicot/base/status.h"
#include "dicot/os/shown_path.h"
#include "dicot/picture/read_picture.h"

namespace dicot {

/// Whether the readers would take a picture of this size. Asked before the file is opened.
inline Status check_writable_size(const char* path, int width, int height) noexcept
{
    if (width >= 1 && height >= 1 && width <= kMaxPictureSide && height <= kMaxPictureSide)
        return {};
    return failure(Fault::kSoftware, "%s: a picture of %d x %d cannot be written, the sides are 1 to %d",
                   shown_path(path), width, height, kMaxPictureSide);
}

} // namespace dicot
