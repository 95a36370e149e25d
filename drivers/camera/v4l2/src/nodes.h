// The nodes of video devices, one after the other.
#pragma once

#include "device.h"
#include "dicot/camera/mode.h"
#include "enumerate.h"

#include <cerrno>
#include <cstdio>

#include <fcntl.h>
#include <unistd.h>

namespace dicot::v4l2 {

constexpr int kMostNodes = 64;

/// Calls see(path, descriptor, errno) for each node that is there until it returns false; -1 where it cannot be opened.
template <typename See>
void for_each_node(See&& see) noexcept
{
    for (int number = 0; number < kMostNodes; ++number) {
        char path[24];
        std::snprintf(path, sizeof path, "/dev/video%d", number);
        const int descriptor = open_without_wait(path, O_RDWR);
        const int error = descriptor < 0 ? errno : 0;
        if (descriptor < 0 && (error == ENOENT || error == ENXIO || error == ENODEV))
            continue;
        const bool more = see(static_cast<const char*>(path), descriptor, error);
        if (descriptor >= 0)
            ::close(descriptor);
        if (!more)
            return;
    }
}

inline bool has_known_format(int descriptor) noexcept
{
    CameraMode first;
    return list_modes(descriptor, {&first, 1}) == 1;
}

} // namespace dicot::v4l2
