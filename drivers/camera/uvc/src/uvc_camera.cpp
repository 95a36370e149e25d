#include "dicot/uvc/uvc_camera.h"

#include "controls.h"
#include "negotiate.h"
#include "stream.h"

#include "dicot/base/arena.h"
#include "dicot/os/clock.h"
#include "dicot/os/memory_block.h"

#include <algorithm>
#include <array>

#include <unistd.h>

namespace dicot {
namespace {

constexpr std::size_t kMostModes = 256;
constexpr std::size_t kMostMemory = std::size_t{256} << 20;
constexpr std::int64_t kComesBackUs = 2'000'000; ///< how long a device may take to come back after a port reset

struct Layout
{
    std::span<std::byte> frames;
    std::span<std::byte> transfers;
    std::span<std::byte> descriptors; ///< for a second look at the port
};

Layout lay_out(Arena& arena, const UvcDevice& device, const UvcOptions& options) noexcept
{
    const std::size_t wanted = options.slot_bytes != 0 ? options.slot_bytes : largest_frame_bytes(device);
    const std::size_t slot = (wanted + Arena::kAlignment - 1) / Arena::kAlignment * Arena::kAlignment;
    Layout layout;
    layout.frames = arena.take<std::byte>(slot * static_cast<std::size_t>(options.slots));
    layout.transfers = arena.take<std::byte>(UvcStream::buffer_bytes(device));
    layout.descriptors = arena.take<std::byte>(kMostUsbDescriptorBytes);
    return layout;
}

/// Isochronous intervals of full speed are frames of 1 ms, of the faster ones microframes (USB 2.0, 5.6.4).
std::int64_t packet_us(UsbSpeed speed, const AlternateSetting& setting) noexcept
{
    return std::int64_t{speed == UsbSpeed::kFull ? 1000 : 125} * setting.intervals_apart;
}

} // namespace

struct UvcCamera::Works
{
    UvcListed listed;
    std::shared_ptr<UsbSession> session;
    MemoryBlock memory;
    std::size_t transfer_bytes = 0; ///< what the largest stream that was planned for takes
    std::span<std::byte> descriptors;
    UsbPort port;
    UvcControls controls;
    FrameRing ring;
    UvcStream stream{ring};
    std::array<CameraMode, kMostModes> modes{};
    std::size_t mode_count = 0;
    CameraMode mode;     ///< of the last start()
    bool wanted = false; ///< start() was called and stop() was not
    std::uint8_t planned_alternate = 0;
    std::uint8_t alternate = 0;

    Status enter();
    Status begin();
    Status reopen(std::int64_t patience_us);
};

/// Opens the listed device and learns what it can do.
Status UvcCamera::Works::enter()
{
    mode_count = modes_of(listed.device, modes);
    TRY(port.open(listed, session));
    controls.read(port, listed.device);
    return {};
}

Status UvcCamera::Works::begin()
{
    const Agreement agreed = TRY(agree(port, listed.device, mode, planned_alternate));
    if (!agreed.setting.bulk) {
        bool full = false;
        if (const int error = port.set_alternate(agreed.setting.setting.number, full); full)
            return failure(
                Fault::kTryAgain,
                "the bus of USB port %s has no bandwidth left for alternate setting %u (%u bytes an interval); "
                "ask for a lower rate, a smaller picture or MJPEG, or plug the cameras into different buses",
                port.name(), unsigned{agreed.setting.setting.number}, agreed.setting.setting.bytes_per_interval);
        else if (error != 0)
            return usb_failure(port.name(), "select an alternate setting", error);
    }
    UvcStream::Plan plan;
    plan.setting = agreed.setting;
    plan.payload_bytes = agreed.control.most_payload_bytes;
    plan.packet_us = packet_us(listed.speed, agreed.setting.setting);
    plan.mode = mode;
    plan.rules = {mode.format == PixelFormat::kMjpeg, frame_bytes(mode),
                  agreed.setting.bulk ? std::size_t{agreed.control.most_payload_bytes} : 0,
                  agreed.control.clock_hz != 0 ? agreed.control.clock_hz : listed.device.clock_hz};
    const Status begun = stream.begin(port, plan);
    if (begun.ok())
        alternate = agreed.setting.setting.number;
    else if (bool full = false; !agreed.setting.bulk)
        port.set_alternate(0, full);
    return begun;
}

/// Closes the device and opens what is at its port now. The same camera only: its buffers were made for it.
Status UvcCamera::Works::reopen(std::int64_t patience_us)
{
    port.close();
    const DeviceText<31> place = listed.identity.port;
    const std::int64_t deadline = monotonic_us() + patience_us;
    for (;;) {
        const Result<UvcListed> found = look_at_port(place.text, descriptors);
        if (found.ok()) {
            const UvcListed& now = found.value();
            if (now.device.vendor != listed.device.vendor || now.device.product != listed.device.product ||
                UvcStream::buffer_bytes(now.device) > transfer_bytes)
                return failure(Fault::kUnavailable,
                               "another camera is at USB port %s now: %04x:%04x instead of %04x:%04x", place.text,
                               unsigned{now.device.vendor}, unsigned{now.device.product},
                               unsigned{listed.device.vendor}, unsigned{listed.device.product});
            listed = now;
            const Status entered = enter();
            if (entered.ok() || monotonic_us() >= deadline)
                return entered;
        } else if (monotonic_us() >= deadline) {
            return found.status();
        }
        ::usleep(100'000);
    }
}

UvcCamera::UvcCamera(std::unique_ptr<Works> works) noexcept : works_(std::move(works)) {}

Result<std::unique_ptr<UvcCamera>> UvcCamera::open(std::string_view which, const UvcOptions& options)
{
    if (options.slots < UvcOptions::kFewestSlots || options.slots > UvcOptions::kMostSlots)
        return failure(Fault::kConfig, "%d frame slots a camera: say %d to %d", options.slots, UvcOptions::kFewestSlots,
                       UvcOptions::kMostSlots);
    auto works = std::make_unique<Works>();
    works->listed = TRY(find_uvc_camera(which));
    const UvcDevice& device = works->listed.device;
    const std::size_t bytes = memory_bytes(device, options);
    if (bytes > kMostMemory)
        return failure(Fault::kConfig,
                       "the camera at USB port %s would take %zu MiB of buffers, at most %zu are given; "
                       "name the size of the largest frame that will be asked for",
                       works->listed.identity.port.text, bytes >> 20, kMostMemory >> 20);
    works->memory = TRY(MemoryBlock::map(bytes, Pages::kResident));
    Arena arena(works->memory.bytes());
    const Layout layout = lay_out(arena, device, options);
    works->transfer_bytes = layout.transfers.size();
    works->descriptors = layout.descriptors;
    works->ring.lay_out(layout.frames, options.slots);
    TRY(works->stream.make(layout.transfers));
    works->session = TRY(UsbSession::share());
    TRY(works->enter());
    return std::unique_ptr<UvcCamera>(new UvcCamera(std::move(works)));
}

UvcCamera::~UvcCamera()
{
    if (works_ == nullptr)
        return;
    const Status stopped = stop();
    // The kernel may still write into buffers whose transfers did not come back: they are left to it.
    if (!stopped.ok() && works_->stream.in_flight() > 0)
        static_cast<void>(works_.release());
}

std::size_t UvcCamera::memory_bytes(const UvcDevice& device, const UvcOptions& options) noexcept
{
    Arena measure;
    lay_out(measure, device, options);
    return measure.peak();
}

const UvcDevice& UvcCamera::device() const noexcept
{
    return works_->listed.device;
}

UsbSpeed UvcCamera::speed() const noexcept
{
    return works_->listed.speed;
}

int UvcCamera::bus() const noexcept
{
    return works_->listed.bus;
}

Result<std::uint32_t> UvcCamera::payload_bytes(const CameraMode& mode)
{
    Works& works = *works_;
    if (works.stream.running())
        return failure(Fault::kTryAgain, "the camera at USB port %s streams; stop it before asking it for another mode",
                       works.listed.identity.port.text);
    return TRY(ask_mode(works.port, works.listed.device, mode)).most_payload_bytes;
}

void UvcCamera::use_alternate(std::uint8_t number) noexcept
{
    works_->planned_alternate = number;
}

std::uint8_t UvcCamera::alternate() const noexcept
{
    return works_->alternate;
}

const CameraIdentity& UvcCamera::identity() const noexcept
{
    return works_->listed.identity;
}

std::span<const CameraMode> UvcCamera::modes() const noexcept
{
    return std::span{works_->modes}.first(works_->mode_count);
}

std::span<const ControlRange> UvcCamera::controls() const noexcept
{
    return works_->controls.ranges();
}

Result<std::int32_t> UvcCamera::get(ControlId id)
{
    return works_->controls.get(works_->port, works_->listed.device, id);
}

Result<std::int32_t> UvcCamera::set(ControlId id, std::int32_t value)
{
    return works_->controls.set(works_->port, works_->listed.device, id, value);
}

Status UvcCamera::start(const CameraMode& mode)
{
    Works& works = *works_;
    TRY(stop());
    if (!works.port.is_open())
        return usb_failure(works.listed.identity.port.text, "start", LIBUSB_ERROR_NO_DEVICE);
    if (const std::size_t bytes = frame_bytes(mode); bytes > works.ring.slot_bytes())
        return failure(Fault::kConfig,
                       "a frame of %d x %d %s has %zu bytes; the camera at USB port %s was opened for %zu", mode.width,
                       mode.height, name_of(mode.format), bytes, works.port.name(), works.ring.slot_bytes());
    works.mode = mode;
    works.wanted = true;
    return works.begin();
}

Result<FrameLease> UvcCamera::next(std::int64_t deadline_us)
{
    Works& works = *works_;
    const char* const port = works.listed.identity.port.text;
    const FrameRing::Taken taken = works.ring.wait(deadline_us);
    if (taken.slot >= 0)
        return FrameLease(*this, taken.slot, taken.frame);
    switch (works.stream.trouble()) {
    case UvcStream::Trouble::kGone:
        return usb_failure(port, "next frame", LIBUSB_ERROR_NO_DEVICE);
    case UvcStream::Trouble::kStalled:
        return failure(Fault::kTryAgain, "the camera at USB port %s halted its endpoint; restart the stream", port);
    case UvcStream::Trouble::kFailing:
        return failure(Fault::kTryAgain, "the camera at USB port %s: no transfer succeeds any more; restart the stream",
                       port);
    case UvcStream::Trouble::kNone:
        break;
    }
    if (!works.stream.running())
        return failure(Fault::kTryAgain, "the camera at USB port %s does not stream; start it", port);
    return failure(Fault::kTryAgain, "the camera at USB port %s delivered no frame in time", port);
}

Status UvcCamera::stop()
{
    Works& works = *works_;
    works.wanted = false;
    if (!works.stream.running())
        return {};
    TRY(works.stream.end());
    works.alternate = 0;
    if (!works.port.is_open())
        return {};
    // A device that is gone answers with an error and has stopped all the same.
    if (bool full = false; !works.listed.device.bulk())
        works.port.set_alternate(0, full);
    else // UVC has no word for the end of a bulk stream; cameras know this one, which clears a stall too
        libusb_clear_halt(works.port.handle(), works.listed.device.settings().front().endpoint);
    return {};
}

Status UvcCamera::shake(Shake how)
{
    Works& works = *works_;
    const bool wanted = works.wanted;
    TRY(stop());
    works.wanted = wanted; // a step that fails leaves it to the next one
    switch (how) {
    case Shake::kRestart:
        break;
    case Shake::kReopen:
        TRY(works.reopen(0));
        break;
    case Shake::kPort:
        // A device that comes back under another address, or is gone, is looked for again; only then is it an error.
        static_cast<void>(works.port.reset());
        TRY(works.reopen(kComesBackUs));
        break;
    }
    return wanted ? start(works.mode) : Status{};
}

void UvcCamera::give_back(int slot) noexcept
{
    works_->ring.give_back(slot);
}

} // namespace dicot
