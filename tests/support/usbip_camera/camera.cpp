#include "camera.h"

#include "descriptors.h"

#include <linux/usb/ch9.h>
#include <linux/usb/video.h>

#include <algorithm>
#include <cerrno>

namespace dicot::usbip {

namespace {

constexpr Microseconds kTransferFollows = 1'000'000; // an unlink that is ahead, by the next message or the one after

} // namespace

/// The eight bytes that a control request begins with, USB 2.0 table 9-2.
struct Camera::Setup
{
    int type, request, value, index, length;

    explicit Setup(const std::array<std::uint8_t, 8>& bytes)
        : type(bytes[0]), request(bytes[1]), value(bytes[2] | bytes[3] << 8), index(bytes[4] | bytes[5] << 8),
          length(bytes[6] | bytes[7] << 8)
    {
    }
    int interface() const { return index & 255; }
    int unit() const { return index >> 8; }
    int selector() const { return value >> 8; }
};

Camera::Camera(CameraModel model, Surroundings around)
    : model_(std::move(model)), product_(model_.product), around_(std::move(around)), negotiation_(model_),
      stream_({model_, around_.frames, faults_, around_.answer, around_.log})
{
}

void Camera::add_fault(PlannedFault fault)
{
    if (fault.next_stream)
        fault.stream = stream_.streams() + 1;
    faults_.add(std::move(fault));
}

void Camera::power_on()
{
    power_off();
    stream_.reset();
    controls_ = Controls();
    negotiation_.reset();
    configuration_ = 0;
    const PlannedFault* name = faults_.at_plug(FaultKind::kProduct);
    model_.product = name != nullptr ? name->text : product_;
}

void Camera::power_off()
{
    stop_streaming();
    stream_.drop_all();
    status_reads_.clear();
    mute_.clear();
    early_.clear();
}

void Camera::stop_streaming()
{
    stream_.stop();
    alternate_ = 0;
    (void)around_.bus.reserve(model_.name, 0);
}

void Camera::take(Request request, Microseconds now)
{
    if (request.kind == Request::Kind::kUnlink) {
        unlink(request, now);
        return;
    }
    if (was_unlinked(request))
        return;
    if (request.endpoint == kVideoEndpoint && request.in) {
        stream_.submit(std::move(request));
        return;
    }
    if (request.endpoint == kStatusEndpoint && request.in) {
        status_reads_.push_back(std::move(request));
        return;
    }
    if (request.endpoint != 0) {
        around_.answer(write_return(request, -EPIPE, 0, {}, {}));
        return;
    }
    Reply reply = control(request.setup, request.out, now);
    if (reply.silent) {
        mute_.push_back(std::move(request));
        return;
    }
    if (reply.data.size() > request.length)
        reply.data.resize(request.length);
    const std::size_t actual = request.in ? reply.data.size() : request.out.size();
    around_.answer(write_return(request, reply.status, reply.status == 0 ? actual : 0, reply.data, {}));
}

void Camera::unlink(const Request& request, Microseconds now)
{
    // The kernel may send this before the transfer itself. If it heard now that there is none, it would give the
    // transfer back, and take its answer later for an error that unplugs the camera.
    if (request.victim > last_submitted_) {
        around_.log("an unlink is ahead of its transfer");
        early_.push_back({request, now + kTransferFollows});
        return;
    }
    const auto is_victim = [&](const Request& waiting) { return waiting.sequence == request.victim; };
    const bool found = stream_.unlink(request.victim) || std::erase_if(status_reads_, is_victim) > 0 ||
                       std::erase_if(mute_, is_victim) > 0;
    around_.answer(write_unlinked(request, found ? -ECONNRESET : 0));
}

bool Camera::was_unlinked(const Request& request)
{
    last_submitted_ = request.sequence;
    const auto early =
        std::ranges::find_if(early_, [&](const EarlyUnlink& one) { return one.request.victim == request.sequence; });
    if (early == early_.end())
        return false;
    around_.answer(write_unlinked(early->request, -ECONNRESET));
    early_.erase(early);
    return true;
}

std::optional<Microseconds> Camera::serve(Microseconds now)
{
    // A transfer that was under way when the cable went is lost, and its unlink may come over the next connection.
    std::erase_if(early_, [&](const EarlyUnlink& early) {
        if (now < early.until)
            return false;
        around_.answer(write_unlinked(early.request, 0));
        return true;
    });
    return stream_.serve(now);
}

std::optional<Microseconds> Camera::deadline() const
{
    std::optional<Microseconds> next = stream_.deadline();
    for (const EarlyUnlink& early : early_)
        next = next ? std::min(*next, early.until) : early.until;
    return next;
}

Reply Camera::control(const std::array<std::uint8_t, 8>& bytes, std::span<const std::uint8_t> out, Microseconds now)
{
    const Setup setup(bytes);
    if ((setup.type & USB_TYPE_MASK) == USB_TYPE_STANDARD)
        return standard(setup, now);
    if ((setup.type & USB_TYPE_MASK) != USB_TYPE_CLASS)
        return Reply::stall();
    if (faults_.in_request(FaultKind::kMute, setup.unit(), setup.selector(), setup.request) != nullptr) {
        around_.log("control: mute");
        return {0, {}, true};
    }
    if (faults_.in_request(FaultKind::kStall, setup.unit(), setup.selector(), setup.request) != nullptr) {
        around_.log("control: stall");
        return Reply::stall();
    }
    Reply reply = class_request(setup, out, now);
    if (const PlannedFault* fault =
            faults_.in_request(FaultKind::kShortReply, setup.unit(), setup.selector(), setup.request)) {
        around_.log("control: short_reply");
        reply.data.resize(std::min(reply.data.size(), static_cast<std::size_t>((*fault)["bytes"])));
    }
    return reply;
}

Reply Camera::standard(const Setup& setup, Microseconds now)
{
    switch (setup.request) {
    case USB_REQ_GET_DESCRIPTOR:
        return descriptor(setup);
    case USB_REQ_GET_STATUS:
        return Reply::of({0, 0});
    case USB_REQ_GET_CONFIGURATION:
        return Reply::of({static_cast<std::uint8_t>(configuration_)});
    case USB_REQ_SET_CONFIGURATION:
        stop_streaming();
        stream_.reset(); // the host sets the configuration again after it has reset the port
        configuration_ = setup.value & 255;
        return configuration_ <= 1 ? Reply{} : Reply::stall();
    case USB_REQ_GET_INTERFACE:
        return Reply::of({static_cast<std::uint8_t>(setup.interface() == kStreamInterface ? alternate_ : 0)});
    case USB_REQ_SET_INTERFACE:
        return set_interface(setup.interface(), setup.value, now);
    case USB_REQ_CLEAR_FEATURE:
        // A host that has done with a bulk endpoint clears its halt, and the camera stops; some clear it at first, too.
        if ((setup.type & USB_RECIP_MASK) == USB_RECIP_ENDPOINT &&
            (setup.index & 15) == static_cast<int>(kVideoEndpoint)) {
            stream_.clear_halt();
            if (model_.bulk && stream_.has_begun())
                stop_streaming();
        }
        return {};
    case USB_REQ_SET_FEATURE:
        return {};
    default:
        return Reply::stall();
    }
}

Reply Camera::descriptor(const Setup& setup)
{
    Bytes bytes;
    switch (setup.value >> 8) {
    case USB_DT_DEVICE:
        bytes = device_descriptor(model_);
        break;
    case USB_DT_CONFIG:
        bytes = configuration_descriptor(model_);
        if (const PlannedFault* cut = faults_.at_plug(FaultKind::kCutDescriptors))
            bytes.resize(std::min(bytes.size(), static_cast<std::size_t>((*cut)["byte"])));
        break;
    case USB_DT_STRING:
        bytes = string_descriptor(model_, setup.value & 255);
        break;
    default:
        break;
    }
    return bytes.empty() ? Reply::stall() : Reply::of(std::move(bytes));
}

Reply Camera::set_interface(int interface, int alternate, Microseconds now)
{
    if (interface == kControlInterface)
        return alternate == 0 ? Reply{} : Reply::stall();
    const int alternates = model_.bulk ? 0 : static_cast<int>(model_.alternates.size());
    if (interface != kStreamInterface || alternate > alternates)
        return Reply::stall();
    stop_streaming();
    stream_.clear_halt();
    if (alternate == 0)
        return {};
    if (const PlannedFault* fault = faults_.in_request(FaultKind::kRefuseInterface, 0, 0, 0)) {
        around_.log("control: refuse_interface");
        return {-static_cast<int>((*fault)["errno"]), {}, false};
    }
    const int bytes = model_.alternates[static_cast<std::size_t>(alternate) - 1].bytes_a_microframe();
    if (!around_.bus.reserve(model_.name, bytes)) {
        around_.log("alternate setting " + std::to_string(alternate) + " does not fit on the bus");
        return {-ENOSPC, {}, false};
    }
    alternate_ = alternate;
    stream_.start(negotiation_.committed(), bytes, now);
    return {};
}

Reply Camera::class_request(const Setup& setup, std::span<const std::uint8_t> out, Microseconds now)
{
    if ((setup.type & USB_RECIP_MASK) != USB_RECIP_INTERFACE)
        return Reply::stall();
    if (setup.interface() == kStreamInterface) {
        Reply reply = negotiation_.request(setup.selector(), setup.request, out);
        const bool committed =
            reply.status == 0 && setup.selector() == UVC_VS_COMMIT_CONTROL && setup.request == UVC_SET_CUR;
        if (committed && model_.bulk) // nothing else starts a bulk stream
            stream_.start(negotiation_.committed(), 0, now);
        return reply;
    }
    if (setup.interface() != kControlInterface)
        return Reply::stall();
    if (setup.unit() == 0) {
        if (setup.selector() == UVC_VC_REQUEST_ERROR_CODE_CONTROL && setup.request == UVC_GET_CUR)
            return Reply::of({static_cast<std::uint8_t>(controls_.last_error())});
        return Reply::stall();
    }
    const Reply reply = controls_.request(setup.unit(), setup.selector(), setup.request, out);
    if (setup.request == UVC_SET_CUR)
        around_.log(std::string(Controls::name_of(setup.unit(), setup.selector())) +
                    (reply.status == 0 ? " set" : " refused"));
    return reply;
}

} // namespace dicot::usbip
