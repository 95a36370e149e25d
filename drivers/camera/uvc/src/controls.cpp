#include "controls.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <bit>
#include <cstdio>

namespace dicot {
namespace {

enum class Home : std::uint8_t
{
    kCamera,
    kProcessing,
};
enum class Kind : std::uint8_t
{
    kNumber, ///< has GET_MIN, GET_MAX and GET_RES
    kSwitch, ///< 0 or 1
    kBitmap, ///< one bit at a time; GET_RES tells which
};

/// UVC 4.2.2.1 and 4.2.2.3, tables; the bits of bmControls are those of tables 3-6 and 3-8.
struct Place
{
    ControlId id;
    Home home;
    std::uint8_t selector;
    std::uint8_t bit;
    std::uint8_t bytes;
    bool has_sign;
    Kind kind;
};

constexpr std::array<Place, kControlCount> kPlaces{{
    {ControlId::kExposureAuto, Home::kCamera, 0x02, 1, 1, false, Kind::kBitmap},
    {ControlId::kExposureTime, Home::kCamera, 0x04, 3, 4, false, Kind::kNumber},
    {ControlId::kExposurePriority, Home::kCamera, 0x03, 2, 1, false, Kind::kSwitch},
    {ControlId::kGain, Home::kProcessing, 0x04, 9, 2, false, Kind::kNumber},
    {ControlId::kWhiteBalanceAuto, Home::kProcessing, 0x0B, 12, 1, false, Kind::kSwitch},
    {ControlId::kWhiteBalance, Home::kProcessing, 0x0A, 6, 2, false, Kind::kNumber},
    {ControlId::kPowerLine, Home::kProcessing, 0x05, 10, 1, false, Kind::kNumber},
    {ControlId::kFocusAuto, Home::kCamera, 0x08, 17, 1, false, Kind::kSwitch},
    {ControlId::kFocus, Home::kCamera, 0x06, 5, 2, false, Kind::kNumber},
    {ControlId::kBrightness, Home::kProcessing, 0x02, 0, 2, true, Kind::kNumber},
    {ControlId::kContrast, Home::kProcessing, 0x03, 1, 2, false, Kind::kNumber},
    {ControlId::kSaturation, Home::kProcessing, 0x07, 3, 2, false, Kind::kNumber},
    {ControlId::kSharpness, Home::kProcessing, 0x08, 4, 2, false, Kind::kNumber},
    {ControlId::kGamma, Home::kProcessing, 0x09, 5, 2, false, Kind::kNumber},
    {ControlId::kBacklight, Home::kProcessing, 0x01, 8, 2, false, Kind::kNumber},
}};

constexpr std::uint32_t kMostValue = 0x7FFF'FFFF;
constexpr std::int64_t kMostReadUs = 3'000'000; ///< then the controls that are left are taken for missing
constexpr std::uint8_t kErrorCode = 0x02;       ///< VC_REQUEST_ERROR_CODE_CONTROL, of the interface itself

const Place& place_of(ControlId id) noexcept
{
    return kPlaces[static_cast<std::size_t>(id)];
}

constexpr bool in_order()
{
    for (std::size_t i = 0; i < kPlaces.size(); ++i)
        if (static_cast<std::size_t>(kPlaces[i].id) != i)
            return false;
    return true;
}
static_assert(in_order());

const UvcEntity& entity_of(const UvcDevice& device, Home home) noexcept
{
    return home == Home::kCamera ? device.camera : device.processing;
}

struct Answer
{
    int error = 0; ///< 0 or of libusb
    std::int32_t value = 0;
};

Answer ask(UsbPort& port, const UvcDevice& device, const Place& place, UvcRequest request) noexcept
{
    std::array<std::byte, 4> data{};
    const int got =
        port.control(entity_of(device, place.home).id, request, place.selector, std::span{data}.first(place.bytes));
    if (got < 0)
        return {got, 0};
    if (got != place.bytes)
        return {LIBUSB_ERROR_IO, 0};
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < place.bytes; ++i)
        value |= std::to_integer<std::uint32_t>(data[i]) << (8 * i);
    if (place.has_sign && place.bytes == 2)
        return {0, static_cast<std::int16_t>(value)};
    return {0, static_cast<std::int32_t>(value < kMostValue ? value : kMostValue)};
}

Answer range_of(UsbPort& port, const UvcDevice& device, const Place& place, ControlRange& range) noexcept
{
    range = {place.id, 0, 1, 1, 0};
    const Answer usual = ask(port, device, place, UvcRequest::kGetDef);
    if (usual.error != 0 && usual.error != LIBUSB_ERROR_PIPE)
        return usual;
    range.usual = usual.value;
    if (place.kind == Kind::kSwitch)
        return ask(port, device, place, UvcRequest::kGetCur);
    if (place.kind == Kind::kBitmap) {
        const Answer modes = ask(port, device, place, UvcRequest::kGetRes);
        if (modes.error != 0 || modes.value <= 0)
            return {modes.error != 0 ? modes.error : LIBUSB_ERROR_IO, 0};
        const auto bits = static_cast<std::uint32_t>(modes.value);
        range.least = std::int32_t{1} << std::countr_zero(bits);
        range.most = std::int32_t{1} << (31 - std::countl_zero(bits));
        return {};
    }
    const Answer least = ask(port, device, place, UvcRequest::kGetMin);
    const Answer most = least.error == 0 ? ask(port, device, place, UvcRequest::kGetMax) : least;
    if (least.error == LIBUSB_ERROR_PIPE && place.id == ControlId::kPowerLine) {
        range.most = 2; // its range is optional (UVC, table 4-32)
        return {};
    }
    if (most.error != 0)
        return most;
    const Answer step = ask(port, device, place, UvcRequest::kGetRes);
    range.least = least.value;
    range.most = most.value;
    range.step = step.error == 0 ? std::max(step.value, 1) : 1;
    return range.least <= range.most ? Answer{} : Answer{LIBUSB_ERROR_IO, 0};
}

/// What the camera says of its last stall (UVC 4.2.1.2).
const char* reason_of_stall(UsbPort& port) noexcept
{
    std::array<std::byte, 1> code{};
    if (port.control(0, UvcRequest::kGetCur, kErrorCode, code) != 1)
        return "no reason told";
    switch (std::to_integer<unsigned>(code[0])) {
    case 1:
        return "not ready";
    case 2:
        return "wrong state";
    case 3:
        return "power";
    case 4:
        return "out of range";
    case 5:
        return "invalid unit";
    case 6:
        return "invalid control";
    case 7:
        return "invalid request";
    case 8:
        return "invalid value";
    default:
        return "no reason told";
    }
}

Status refused(UsbPort& port, const char* verb, ControlId id, int error) noexcept
{
    char what[96];
    std::snprintf(what, sizeof what, "%s %s%s%s", verb, name_of(id), error == LIBUSB_ERROR_PIPE ? ", " : "",
                  error == LIBUSB_ERROR_PIPE ? reason_of_stall(port) : "");
    return usb_failure(port.name(), what, error);
}

} // namespace

void UvcControls::read(UsbPort& port, const UvcDevice& device) noexcept
{
    count_ = 0;
    int silences = 0;
    const std::int64_t deadline = monotonic_us() + kMostReadUs;
    for (const Place& place : kPlaces) {
        const UvcEntity& entity = entity_of(device, place.home);
        if (entity.id == 0 || (entity.controls >> place.bit & 1u) == 0 || monotonic_us() > deadline)
            continue;
        ControlRange range;
        const Answer answer = range_of(port, device, place, range);
        if (answer.error == 0)
            ranges_[count_++] = range;
        if (answer.error == LIBUSB_ERROR_NO_DEVICE || (answer.error == LIBUSB_ERROR_TIMEOUT && ++silences == 2))
            return;
    }
}

Result<std::int32_t> UvcControls::get(UsbPort& port, const UvcDevice& device, ControlId id) const noexcept
{
    if (std::ranges::find(ranges(), id, &ControlRange::id) == ranges().end())
        return failure(Fault::kUnavailable, "the camera at USB port %s has no %s", port.name(), name_of(id));
    const Answer answer = ask(port, device, place_of(id), UvcRequest::kGetCur);
    if (answer.error != 0)
        return refused(port, "read", id, answer.error);
    return answer.value;
}

Result<std::int32_t> UvcControls::set(UsbPort& port, const UvcDevice& device, ControlId id,
                                      std::int32_t value) const noexcept
{
    const auto range = std::ranges::find(ranges(), id, &ControlRange::id);
    if (range == ranges().end())
        return failure(Fault::kUnavailable, "the camera at USB port %s has no %s", port.name(), name_of(id));
    const Place& place = place_of(id);
    const std::int32_t held = place.kind == Kind::kBitmap ? value : nearest_value(*range, value);
    std::array<std::byte, 4> data{};
    for (std::size_t i = 0; i < place.bytes; ++i)
        data[i] = static_cast<std::byte>(static_cast<std::uint32_t>(held) >> (8 * i));
    const int sent = port.control(entity_of(device, place.home).id, UvcRequest::kSetCur, place.selector,
                                  std::span{data}.first(place.bytes));
    if (sent < 0)
        return refused(port, "set", id, sent);
    return get(port, device, id);
}

} // namespace dicot
