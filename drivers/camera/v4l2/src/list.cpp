#include "device.h"
#include "dicot/v4l2/v4l2_camera.h"
#include "nodes.h"

#include <cerrno>
#include <cstdio>

#include <fcntl.h>
#include <unistd.h>

namespace dicot {

V4l2Nodes list_v4l2_cameras() noexcept
{
    V4l2Nodes found;
    v4l2::for_each_node([&](const char* path, int descriptor, int error) {
        CameraIdentity identity;
        if (descriptor < 0)
            found.denied += error == EACCES || error == EPERM ? 1 : 0;
        else if (v4l2::identify(descriptor, identity) && v4l2::has_known_format(descriptor)) {
            if (found.count == V4l2Nodes::kMost) {
                ++found.left_out;
                return true;
            }
            V4l2Node& node = found.nodes[static_cast<std::size_t>(found.count++)];
            std::snprintf(node.path, sizeof node.path, "%s", path);
            node.identity = identity;
        }
        return true;
    });
    return found;
}

UsbPlace usb_place_of(const char* port) noexcept
{
    if (!v4l2::is_port(port))
        return {};
    UsbPlace place{.bus = v4l2::read_number(v4l2::UsbAttribute{port, "busnum"}.path, -1)};
    const int megabits = v4l2::read_number(v4l2::UsbAttribute{port, "speed"}.path, 480);
    if (megabits >= 5000)
        place.speed = UsbSpeed::kSuper;
    else if (megabits < 480)
        place.speed = UsbSpeed::kFull;
    return place;
}

std::size_t read_usb_descriptors(const char* port, std::span<std::byte> into) noexcept
{
    return v4l2::is_port(port) ? v4l2::read_small(v4l2::UsbAttribute{port, "descriptors"}.path, into) : 0;
}

} // namespace dicot
