#include "controls.h"

#include <linux/usb/video.h>

#include <cerrno>

namespace dicot::usbip {

namespace {

struct Knob
{
    std::string_view name;
    int entity;
    int selector;
    int bit; ///< in the entity's bitmap
    int bytes;
    bool is_signed;
    bool has_range; ///< GET_MIN, GET_MAX, GET_RES; switches have none
    std::int32_t least, most, step, usual;
    int automatism; ///< selector of the automatism of the same entity, 0: none
};

// GET_RES of the exposure mode is the bitmap of modes (UVC 1.1, 4.2.2.1.2): 1 manual, 8 aperture priority.
constexpr std::int32_t kExposureManual = 1;
constexpr std::int32_t kExposureModes = 1 | 8;

constexpr Knob kKnobs[] = {
    {"exposure mode", kCameraTerminal, UVC_CT_AE_MODE_CONTROL, 1, 1, false, false, 1, 8, kExposureModes, 8, 0},
    {"exposure time", kCameraTerminal, UVC_CT_EXPOSURE_TIME_ABSOLUTE_CONTROL, 3, 4, false, true, 3, 2047, 1, 250,
     UVC_CT_AE_MODE_CONTROL},
    {"focus", kCameraTerminal, UVC_CT_FOCUS_ABSOLUTE_CONTROL, 5, 2, false, true, 0, 250, 5, 0,
     UVC_CT_FOCUS_AUTO_CONTROL},
    {"focus automatism", kCameraTerminal, UVC_CT_FOCUS_AUTO_CONTROL, 17, 1, false, false, 0, 1, 1, 1, 0},
    {"brightness", kProcessingUnit, UVC_PU_BRIGHTNESS_CONTROL, 0, 2, true, true, -64, 64, 1, 0, 0},
    {"contrast", kProcessingUnit, UVC_PU_CONTRAST_CONTROL, 1, 2, false, true, 0, 255, 1, 128, 0},
    {"white balance", kProcessingUnit, UVC_PU_WHITE_BALANCE_TEMPERATURE_CONTROL, 6, 2, false, true, 2800, 6500, 10,
     4600, UVC_PU_WHITE_BALANCE_TEMPERATURE_AUTO_CONTROL},
    {"gain", kProcessingUnit, UVC_PU_GAIN_CONTROL, 9, 2, false, true, 0, 255, 1, 64, 0},
    {"power line frequency", kProcessingUnit, UVC_PU_POWER_LINE_FREQUENCY_CONTROL, 10, 1, false, true, 0, 2, 1, 1, 0},
    {"white balance automatism", kProcessingUnit, UVC_PU_WHITE_BALANCE_TEMPERATURE_AUTO_CONTROL, 12, 1, false, false, 0,
     1, 1, 1, 0},
};

// Reasons of VC_REQUEST_ERROR_CODE_CONTROL, UVC 1.1 table 4-7.
enum Reason
{
    kNoError = 0,
    kWrongState = 2,
    kOutOfRange = 4,
    kInvalidUnit = 5,
    kInvalidControl = 6,
    kInvalidRequest = 7,
};

const Knob* find(int entity, int selector)
{
    for (const Knob& knob : kKnobs)
        if (knob.entity == entity && knob.selector == selector)
            return &knob;
    return nullptr;
}

Bytes bytes_of(const Knob& knob, std::int32_t value)
{
    Bytes bytes;
    for (int i = 0; i < knob.bytes; ++i)
        bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (8 * i)));
    return bytes;
}

std::int64_t value_in(const Knob& knob, std::span<const std::uint8_t> data)
{
    std::int64_t value = 0;
    for (std::size_t i = 0; i < data.size(); ++i)
        value |= std::int64_t{data[i]} << (8 * i);
    const std::int64_t half = std::int64_t{1} << (8 * knob.bytes - 1);
    return knob.is_signed && value >= half ? value - 2 * half : value;
}

bool is_allowed(const Knob& knob, std::int64_t value)
{
    if (knob.selector == UVC_CT_AE_MODE_CONTROL && knob.entity == kCameraTerminal)
        return value == 1 || value == 8;
    return value >= knob.least && value <= knob.most && (value - knob.least) % knob.step == 0;
}

} // namespace

Reply Reply::stall()
{
    return {-EPIPE, {}, false};
}

std::array<std::uint8_t, 3> control_bits(int entity)
{
    std::array<std::uint8_t, 3> bits{};
    for (const Knob& knob : kKnobs)
        if (knob.entity == entity) {
            std::uint8_t& byte = bits[static_cast<std::size_t>(knob.bit / 8)];
            byte = static_cast<std::uint8_t>(byte | 1 << knob.bit % 8);
        }
    return bits;
}

Controls::Controls()
{
    for (const Knob& knob : kKnobs)
        values_[{knob.entity, knob.selector}] = knob.usual;
}

std::string_view Controls::name_of(int entity, int selector)
{
    const Knob* knob = find(entity, selector);
    return knob != nullptr ? knob->name : "unknown control";
}

bool Controls::held_by_automatism(int entity, int selector) const
{
    const Knob* knob = find(entity, selector);
    if (knob->automatism == 0)
        return false;
    const std::int32_t mode = values_.at({entity, knob->automatism});
    return knob->automatism == UVC_CT_AE_MODE_CONTROL && entity == kCameraTerminal ? mode != kExposureManual
                                                                                   : mode != 0;
}

Reply Controls::refuse(int reason)
{
    last_error_ = reason;
    return Reply::stall();
}

Reply Controls::request(int entity, int selector, int request, std::span<const std::uint8_t> data)
{
    if (entity != kCameraTerminal && entity != kProcessingUnit)
        return refuse(kInvalidUnit);
    const Knob* knob = find(entity, selector);
    if (knob == nullptr)
        return refuse(kInvalidControl);
    const bool held = held_by_automatism(entity, selector);
    std::int32_t& value = values_.at({entity, selector});
    last_error_ = kNoError;
    switch (request) {
    case UVC_SET_CUR: {
        if (held)
            return refuse(kWrongState);
        if (data.size() != static_cast<std::size_t>(knob->bytes))
            return refuse(kInvalidRequest);
        const std::int64_t wanted = value_in(*knob, data);
        if (!is_allowed(*knob, wanted))
            return refuse(kOutOfRange);
        value = static_cast<std::int32_t>(wanted);
        return {};
    }
    case UVC_GET_CUR:
        return Reply::of(bytes_of(*knob, value));
    case UVC_GET_DEF:
        return Reply::of(bytes_of(*knob, knob->usual));
    case UVC_GET_LEN:
        return Reply::of({static_cast<std::uint8_t>(knob->bytes), 0});
    case UVC_GET_INFO: // can be read and set; bit 2: an automatism holds it
        return Reply::of({static_cast<std::uint8_t>(3 | (held ? 4 : 0))});
    case UVC_GET_RES:
        if (knob->has_range || knob->step == kExposureModes)
            return Reply::of(bytes_of(*knob, knob->step));
        return refuse(kInvalidRequest);
    case UVC_GET_MIN:
    case UVC_GET_MAX:
        if (knob->has_range)
            return Reply::of(bytes_of(*knob, request == UVC_GET_MIN ? knob->least : knob->most));
        return refuse(kInvalidRequest);
    default:
        return refuse(kInvalidRequest);
    }
}

} // namespace dicot::usbip
