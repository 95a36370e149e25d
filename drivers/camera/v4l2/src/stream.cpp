#include "buffer_judge.h"
#include "device.h"
#include "dicot/os/clock.h"
#include "dicot/v4l2/v4l2_camera.h"
#include "kernel_words.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include <poll.h>
#include <sys/mman.h>

namespace dicot {
namespace {

/// No webcam has frames beyond this; what a device says of its own is not asked of the kernel.
constexpr std::uint32_t kMostFrameBytes = 128U * 1024 * 1024;

v4l2_buffer buffer_of(std::uint32_t index) noexcept
{
    v4l2_buffer buffer{};
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = index;
    return buffer;
}

int request_buffers(int descriptor, std::uint32_t& count) noexcept
{
    v4l2_requestbuffers request{};
    request.count = count;
    request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    request.memory = V4L2_MEMORY_MMAP;
    const int error = v4l2::call(descriptor, VIDIOC_REQBUFS, request);
    count = request.count;
    return error;
}

} // namespace

int V4l2Camera::count(SlotState state) const noexcept
{
    return static_cast<int>(std::ranges::count(slots_, state, &Slot::state));
}

void V4l2Camera::unmap(Slot& slot) noexcept
{
    if (!slot.mapped.empty())
        ::munmap(slot.mapped.data(), slot.mapped.size());
    slot.mapped = {};
    slot.state = SlotState::kFree;
}

bool V4l2Camera::queue(Slot& slot) noexcept
{
    v4l2_buffer buffer = buffer_of(slot.index);
    const bool queued = v4l2::call(descriptor_, VIDIOC_QBUF, buffer) == 0;
    slot.state = queued ? SlotState::kQueued : SlotState::kIdle;
    return queued;
}

Status V4l2Camera::agree_on(const CameraMode& mode) noexcept
{
    const char* port = node_.identity.port.text;
    const std::uint32_t fourcc = v4l2::fourcc_of(mode.format);
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    v4l2_pix_format& pix = format.fmt.pix;
    pix.width = static_cast<std::uint32_t>(mode.width);
    pix.height = static_cast<std::uint32_t>(mode.height);
    pix.pixelformat = fourcc;
    pix.field = V4L2_FIELD_NONE;
    if (mode.format == PixelFormat::kMjpeg && // some devices name the same thing JPEG
        v4l2::call(descriptor_, VIDIOC_TRY_FMT, format) == 0 && pix.pixelformat != fourcc)
        pix.pixelformat = V4L2_PIX_FMT_JPEG;
    const std::uint32_t wanted = mode.format == PixelFormat::kMjpeg ? pix.pixelformat : fourcc;
    pix.width = static_cast<std::uint32_t>(mode.width);
    pix.height = static_cast<std::uint32_t>(mode.height);
    pix.bytesperline = 0;
    pix.sizeimage = 0;
    if (const int error = v4l2::call(descriptor_, VIDIOC_S_FMT, format); error != 0)
        return failed("choosing the mode", error);
    const bool progressive = pix.field == V4L2_FIELD_NONE || pix.field == V4L2_FIELD_ANY;
    if (fourcc == 0 || pix.pixelformat != wanted || pix.width != static_cast<std::uint32_t>(mode.width) ||
        pix.height != static_cast<std::uint32_t>(mode.height) || !progressive)
        return failure(Fault::kUnavailable,
                       "camera %s: offers %c%c%c%c %ux%u%s where %s %dx%d was asked for; choose one of its modes", port,
                       static_cast<char>(pix.pixelformat & 0x7F), static_cast<char>(pix.pixelformat >> 8 & 0x7F),
                       static_cast<char>(pix.pixelformat >> 16 & 0x7F), static_cast<char>(pix.pixelformat >> 24 & 0x7F),
                       pix.width, pix.height, progressive ? "" : " interlaced", name_of(mode.format), mode.width,
                       mode.height);
    const std::size_t bytes = frame_bytes(mode);
    const std::uint32_t row = mode.format == PixelFormat::kYuyv ? 2 * pix.width : pix.width;
    if (pix.sizeimage < bytes || pix.sizeimage > kMostFrameBytes || (bytes != 0 && pix.bytesperline > row))
        return failure(
            Fault::kUnavailable,
            "camera %s: its %s frames have %u bytes in rows of %u, which dicot does not read; choose another mode",
            port, name_of(mode.format), pix.sizeimage, pix.bytesperline);
    mode_ = mode;
    return agree_on_rate(mode);
}

Status V4l2Camera::agree_on_rate(const CameraMode& mode) noexcept
{
    v4l2_streamparm rate{};
    rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    v4l2_captureparm& capture = rate.parm.capture;
    if (v4l2::call(descriptor_, VIDIOC_G_PARM, rate) != 0 || (capture.capability & V4L2_CAP_TIMEPERFRAME) == 0)
        return {};
    capture.timeperframe = v4l2::fraction_of(mode.interval_100ns);
    if (const int error = v4l2::call(descriptor_, VIDIOC_S_PARM, rate); error != 0)
        return failed("choosing the rate", error);
    if (const std::uint32_t interval = v4l2::interval_of(capture.timeperframe); interval != 0)
        mode_.interval_100ns = interval;
    return {};
}

Status V4l2Camera::map_buffers() noexcept
{
    std::uint32_t buffers = kBuffers;
    if (const int error = request_buffers(descriptor_, buffers); error != 0)
        return failed("asking for buffers", error);
    if (buffers < 2 || static_cast<int>(buffers) > count(SlotState::kFree))
        return failure(Fault::kUnavailable, "camera %s: gives %u buffers where 2 to %d are of use; use another camera",
                       node_.identity.port.text, buffers, count(SlotState::kFree));
    for (std::uint32_t index = 0; index < buffers; ++index) {
        v4l2_buffer buffer = buffer_of(index);
        if (const int error = v4l2::call(descriptor_, VIDIOC_QUERYBUF, buffer); error != 0)
            return failed("asking for a buffer", error);
        void* at =
            ::mmap(nullptr, buffer.length, PROT_READ, MAP_SHARED, descriptor_, static_cast<off_t>(buffer.m.offset));
        if (at == MAP_FAILED)
            return failed("mapping a buffer", errno);
        Slot& slot = *std::ranges::find(slots_, SlotState::kFree, &Slot::state);
        slot.index = index;
        slot.mapped = {static_cast<std::byte*>(at), buffer.length};
        slot.state = SlotState::kIdle;
    }
    for (Slot& slot : slots_)
        if (slot.state == SlotState::kIdle && !queue(slot))
            return failed("queueing a buffer", errno);
    return {};
}

Status V4l2Camera::start(const CameraMode& mode)
{
    if (descriptor_ < 0)
        return failed("starting", ENODEV);
    if (streaming_)
        TRY(stop());
    if (release_due_ || count(SlotState::kFree) < kBuffers)
        return failure(Fault::kTryAgain, "camera %s: frames of its last stream are still lent; let them go first",
                       node_.identity.port.text);
    TRY(agree_on(mode));
    Status status = map_buffers();
    if (status.ok()) {
        int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
        const int error = v4l2::call(descriptor_, VIDIOC_STREAMON, type);
        if (error == ENOSPC)
            status =
                failure(Fault::kTryAgain,
                        "camera %s: its USB bus has no bandwidth left for %s %dx%d; choose MJPEG or a lower rate, or "
                        "plug the cameras into different buses",
                        node_.identity.port.text, name_of(mode.format), mode.width, mode.height);
        else if (error != 0)
            status = failed("starting to stream", error);
    }
    if (!status.ok()) {
        release_buffers();
        return status;
    }
    streaming_ = true;
    first_ = true;
    return {};
}

void V4l2Camera::release_buffers() noexcept
{
    for (Slot& slot : slots_) {
        if (slot.state == SlotState::kLent)
            slot.state = SlotState::kOrphan;
        else if (slot.state != SlotState::kOrphan)
            unmap(slot);
    }
    std::uint32_t none = 0;
    release_due_ = request_buffers(descriptor_, none) == EBUSY && count(SlotState::kOrphan) > 0;
}

void V4l2Camera::end_stream() noexcept
{
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    (void)v4l2::call(descriptor_, VIDIOC_STREAMOFF, type); // a device that is gone has nothing to give back
    streaming_ = false;
    release_buffers();
}

Status V4l2Camera::stop()
{
    resume_ = false;
    if (streaming_)
        end_stream();
    return {};
}

void V4l2Camera::give_back(int number) noexcept
{
    Slot& slot = slots_[static_cast<std::size_t>(number)];
    if (slot.state == SlotState::kLent) {
        (void)queue(slot); // next() tries again with what could not be queued
        return;
    }
    unmap(slot);
    if (release_due_ && count(SlotState::kOrphan) == 0) {
        std::uint32_t none = 0;
        (void)request_buffers(descriptor_, none);
        release_due_ = false;
    }
}

Result<FrameLease> V4l2Camera::lend(const void* dequeued) noexcept
{
    const auto& buffer = *static_cast<const v4l2_buffer*>(dequeued);
    const auto held = std::ranges::find_if(
        slots_, [&](const Slot& one) { return one.state == SlotState::kQueued && one.index == buffer.index; });
    if (held == slots_.end())
        return failure(Fault::kUnavailable,
                       "camera %s: its driver gives a buffer that it was not given; update the kernel",
                       node_.identity.port.text);
    held->state = SlotState::kLent;
    Frame frame;
    frame.mode = mode_;
    frame.sequence = buffer.sequence;
    frame.lost_before = first_ ? 0 : v4l2::lost_between(expected_, buffer.sequence);
    frame.start_us = v4l2::start_us(buffer, mode_.interval_100ns, monotonic_us());
    v4l2::judge(buffer, held->mapped, frame, held->flaw);
    expected_ = buffer.sequence + 1;
    first_ = false;
    return FrameLease{*this, static_cast<int>(held - slots_.begin()), frame};
}

Status V4l2Camera::wait_until(std::int64_t deadline_us, bool& broken) noexcept
{
    const std::int64_t left_us = deadline_us - monotonic_us();
    if (left_us <= 0)
        return failure(Fault::kTryAgain, "camera %s: no frame came in time", node_.identity.port.text);
    const timespec left{static_cast<time_t>(left_us / 1'000'000), static_cast<long>(left_us % 1'000'000 * 1000)};
    pollfd one{descriptor_, POLLIN, 0};
    const int ready = ::ppoll(&one, 1, &left, nullptr);
    if (ready < 0 && errno != EINTR)
        return failed("waiting for a frame", errno);
    broken = ready > 0 && (one.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;
    return {};
}

Result<FrameLease> V4l2Camera::next(std::int64_t deadline_us)
{
    const char* port = node_.identity.port.text;
    if (!streaming_)
        return failure(Fault::kUnavailable, "camera %s: does not stream; start it first", port);
    const std::int64_t latest_us = std::min(deadline_us, monotonic_us() + std::int64_t{kMostWaitMs} * 1000);
    bool broken = false;
    for (;;) {
        for (Slot& slot : slots_)
            if (slot.state == SlotState::kIdle)
                (void)queue(slot);
        if (count(SlotState::kQueued) == 0 && count(SlotState::kIdle) == 0)
            return failure(Fault::kTryAgain, "camera %s: all its %d buffers are lent; let a frame go first", port,
                           count(SlotState::kLent));
        v4l2_buffer buffer = buffer_of(0);
        const int error = v4l2::call(descriptor_, VIDIOC_DQBUF, buffer);
        if (error == 0)
            return lend(&buffer);
        if (error != EAGAIN)
            return failed("taking a frame", error);
        if (broken)
            return failed("waiting for a frame", EIO);
        TRY(wait_until(latest_us, broken));
    }
}

} // namespace dicot
