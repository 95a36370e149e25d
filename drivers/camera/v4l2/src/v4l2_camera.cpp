#include "dicot/v4l2/v4l2_camera.h"

#include "device.h"
#include "enumerate.h"
#include "kernel_words.h"
#include "nodes.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace dicot {

V4l2Camera::~V4l2Camera()
{
    close();
    for (Slot& slot : slots_)
        unmap(slot);
}

Status V4l2Camera::failed(const char* what, int error) const noexcept
{
    const char* port = node_.identity.port.text;
    if (error == ENODEV || error == ENXIO)
        return failure(Fault::kUnavailable, "camera %s: is gone (%s); check its plug and cable", port, what);
    if (error == EBUSY)
        return failure(Fault::kUnavailable, "camera %s: is in use by another program (%s); stop that program", port,
                       what);
    return failure(Fault::kUnavailable, "camera %s: %s failed (%s); unplug it and plug it in again", port, what,
                   strerrordesc_np(error));
}

Status V4l2Camera::open_node(const char* path) noexcept
{
    const int descriptor = v4l2::open_without_wait(path, O_RDWR);
    if (descriptor < 0) {
        const int error = errno;
        if (error == EACCES || error == EPERM)
            return failure(Fault::kUnavailable, "%s: no permission to use this camera; add its user to the group video",
                           path);
        return failure(Fault::kUnavailable, "%s: cannot be opened (%s); check that the camera is plugged in", path,
                       strerrordesc_np(error));
    }
    CameraIdentity identity;
    if (!v4l2::identify(descriptor, identity)) {
        ::close(descriptor);
        return failure(Fault::kUnavailable, "%s: takes no pictures by streaming; name another device", path);
    }
    mode_count_ = v4l2::list_modes(descriptor, modes_);
    if (mode_count_ == 0) {
        ::close(descriptor);
        return failure(Fault::kUnavailable, "%s (%s): offers none of YUYV, MJPEG, NV12 and GREY; use another camera",
                       path, identity.name.text);
    }
    control_count_ = v4l2::list_controls(descriptor, controls_);
    descriptor_ = descriptor;
    node_.identity = identity;
    std::snprintf(node_.path, sizeof node_.path, "%s", path);
    return {};
}

Status V4l2Camera::open(const char* where) noexcept
{
    close();
    if (std::strncmp(where, "/dev/", 5) == 0)
        return open_node(where);
    char path[sizeof node_.path] = {};
    bool denied = false;
    v4l2::for_each_node([&](const char* node, int descriptor, int error) {
        CameraIdentity identity;
        denied = denied || error == EACCES || error == EPERM;
        const bool fits =
            where[0] != '\0' && descriptor >= 0 && v4l2::identify(descriptor, identity) &&
            (std::strcmp(identity.port.text, where) == 0 || std::strcmp(identity.serial.text, where) == 0) &&
            v4l2::has_known_format(descriptor);
        if (fits)
            std::snprintf(path, sizeof path, "%s", node);
        return !fits;
    });
    if (path[0] != '\0')
        return open_node(path);
    return failure(Fault::kUnavailable, "there is no camera at '%.60s'; %s", where,
                   denied ? "some devices may not be opened by this user: add it to the group video"
                          : "plug it in there, or name the port where it is");
}

void V4l2Camera::close() noexcept
{
    if (descriptor_ < 0)
        return;
    end_stream();
    ::close(descriptor_);
    descriptor_ = -1;
    release_due_ = false; // the kernel frees what the orphans leave behind when they are unmapped
}

Result<std::int32_t> V4l2Camera::read_control(ControlId id) const noexcept
{
    v4l2_ext_control control{};
    control.id = v4l2::kernel_id(id);
    v4l2_ext_controls all{};
    all.which = V4L2_CTRL_WHICH_CUR_VAL;
    all.count = 1;
    all.controls = &control;
    if (const int error = v4l2::call(descriptor_, VIDIOC_G_EXT_CTRLS, all); error != 0)
        return failed(name_of(id), error);
    return v4l2::from_kernel(id, control.value);
}

Status V4l2Camera::check_control(ControlId id) const noexcept
{
    if (descriptor_ < 0)
        return failed(name_of(id), ENODEV);
    if (std::ranges::find(controls(), id, &ControlRange::id) == controls().end())
        return failure(Fault::kUnavailable, "camera %s: has no control '%s'; leave it out", node_.identity.port.text,
                       name_of(id));
    return {};
}

Result<std::int32_t> V4l2Camera::get(ControlId id)
{
    TRY(check_control(id));
    return read_control(id);
}

Result<std::int32_t> V4l2Camera::set(ControlId id, std::int32_t value)
{
    TRY(check_control(id));
    v4l2_ext_control control{};
    control.id = v4l2::kernel_id(id);
    control.value = v4l2::to_kernel(id, value);
    v4l2_ext_controls all{};
    all.which = V4L2_CTRL_WHICH_CUR_VAL;
    all.count = 1;
    all.controls = &control;
    const int error = v4l2::call(descriptor_, VIDIOC_S_EXT_CTRLS, all);
    if (error == EACCES || error == EBUSY)
        return failure(Fault::kUnavailable, "camera %s: '%s' cannot be set now; switch its automatic off first",
                       node_.identity.port.text, name_of(id));
    if (error == EINVAL || error == ERANGE)
        return failure(Fault::kUnavailable, "camera %s: '%s' cannot be %d; choose a value of its range",
                       node_.identity.port.text, name_of(id), value);
    if (error != 0)
        return failed(name_of(id), error);
    return read_control(id);
}

} // namespace dicot
