#include "enumerate.h"

#include "device.h"
#include "dicot/os/clock.h"
#include "dicot/picture/read_picture.h"
#include "kernel_words.h"

#include <algorithm>
#include <array>

namespace dicot::v4l2 {
namespace {

constexpr std::uint32_t kMostFormats = 32;
constexpr std::uint32_t kMostSizes = 64;
constexpr std::uint32_t kMostIntervals = 32;
/// A device that answers each question late is asked no more after this; one question takes at most 5 s in the kernel.
constexpr std::int64_t kMostUs = 5'000'000;

struct Size
{
    std::uint32_t width, height;
};
constexpr std::array<Size, 9> kUsualSizes{{{320, 240},
                                           {640, 360},
                                           {640, 480},
                                           {800, 600},
                                           {1024, 768},
                                           {1280, 720},
                                           {1280, 960},
                                           {1600, 1200},
                                           {1920, 1080}}};
constexpr std::array<std::uint32_t, 6> kUsualIntervals{333333, 400000, 500000, 666666, 1000000, 2000000};

class Modes
{
public:
    Modes(int descriptor, std::span<CameraMode> into) noexcept
        : descriptor_(descriptor), into_(into), until_us_(monotonic_us() + kMostUs)
    {
    }

    std::size_t list() noexcept
    {
        for (std::uint32_t i = 0; i < kMostFormats && !ended(); ++i) {
            v4l2_fmtdesc told{};
            told.index = i;
            told.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
            if (call(descriptor_, VIDIOC_ENUM_FMT, told) != 0)
                break;
            const std::optional<PixelFormat> format = format_of(told.pixelformat);
            if (format && (told.flags & V4L2_FMT_FLAG_EMULATED) == 0)
                list_sizes(told.pixelformat, *format);
        }
        return count_;
    }

private:
    bool ended() const noexcept { return count_ == into_.size() || monotonic_us() > until_us_; }

    void list_sizes(std::uint32_t fourcc, PixelFormat format) noexcept
    {
        for (std::uint32_t i = 0; i < kMostSizes && !ended(); ++i) {
            v4l2_frmsizeenum told{};
            told.index = i;
            told.pixel_format = fourcc;
            if (call(descriptor_, VIDIOC_ENUM_FRAMESIZES, told) != 0)
                return;
            if (told.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
                list_intervals(fourcc, format, {told.discrete.width, told.discrete.height});
                continue;
            }
            for (const Size& size : kUsualSizes)
                if (within(size.width, told.stepwise.min_width, told.stepwise.max_width, told.stepwise.step_width) &&
                    within(size.height, told.stepwise.min_height, told.stepwise.max_height, told.stepwise.step_height))
                    list_intervals(fourcc, format, size);
            return;
        }
    }

    void list_intervals(std::uint32_t fourcc, PixelFormat format, Size size) noexcept
    {
        constexpr auto kMost = static_cast<std::uint32_t>(kMaxPictureSide);
        if (size.width == 0 || size.height == 0 || size.width > kMost || size.height > kMost)
            return;
        const CameraMode mode{format, static_cast<int>(size.width), static_cast<int>(size.height), 0};
        for (std::uint32_t i = 0; i < kMostIntervals && !ended(); ++i) {
            v4l2_frmivalenum told{};
            told.index = i;
            told.pixel_format = fourcc;
            told.width = size.width;
            told.height = size.height;
            if (call(descriptor_, VIDIOC_ENUM_FRAMEINTERVALS, told) != 0)
                return;
            if (told.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
                add(mode, interval_of(told.discrete));
                continue;
            }
            const std::uint32_t least = interval_of(told.stepwise.min);
            const std::uint32_t most = interval_of(told.stepwise.max);
            for (const std::uint32_t interval : kUsualIntervals)
                if (interval >= least && interval <= most)
                    add(mode, interval);
            return;
        }
    }

    void add(CameraMode mode, std::uint32_t interval) noexcept
    {
        if (interval != 0 && count_ < into_.size()) {
            mode.interval_100ns = interval;
            into_[count_++] = mode;
        }
    }

    static bool within(std::uint32_t value, std::uint32_t least, std::uint32_t most, std::uint32_t step) noexcept
    {
        return value >= least && value <= most && (value - least) % std::max(step, 1U) == 0;
    }

    int descriptor_;
    std::span<CameraMode> into_;
    std::int64_t until_us_;
    std::size_t count_ = 0;
};

} // namespace

std::size_t list_modes(int descriptor, std::span<CameraMode> into) noexcept
{
    return Modes{descriptor, into}.list();
}

std::size_t list_controls(int descriptor, std::span<ControlRange> into) noexcept
{
    const std::int64_t until_us = monotonic_us() + kMostUs;
    std::size_t count = 0;
    for (int i = 0; i < kControlCount && count < into.size() && monotonic_us() < until_us; ++i) {
        const auto id = static_cast<ControlId>(i);
        v4l2_query_ext_ctrl told{};
        told.id = kernel_id(id);
        if (call(descriptor, VIDIOC_QUERY_EXT_CTRL, told) != 0)
            continue;
        if (const std::optional<ControlRange> range = range_of(id, told))
            into[count++] = *range;
    }
    return count;
}

} // namespace dicot::v4l2
