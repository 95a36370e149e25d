// The knobs of a virtual camera: camera terminal and processing unit.
#pragma once

#include "model.h"
#include "wire.h"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>

namespace dicot::usbip {

/// What a control request comes back with.
struct Reply
{
    int status = 0;      ///< 0, -EPIPE for a stall, another negative errno for a host controller's refusal
    Bytes data;          ///< towards the host
    bool silent = false; ///< no answer at all: the host is to time out

    static Reply of(Bytes data) { return {0, std::move(data), false}; }
    static Reply stall();
};

/// The control bitmap of an entity's descriptor, UVC 1.1 tables 3-6 and 3-8.
std::array<std::uint8_t, 3> control_bits(int entity);

/// The values of all controls, with the rules of UVC 1.1 chapter 4: bad requests, ranges and states stall and leave
/// their reason behind; a value that an automatism holds cannot be set.
class Controls
{
public:
    Controls();

    /// A class request to `entity`; `data` is what the host sent.
    Reply request(int entity, int selector, int request, std::span<const std::uint8_t> data);
    /// VC_REQUEST_ERROR_CODE_CONTROL: why the last request stalled.
    int last_error() const { return last_error_; }
    /// Names the control, for the log: "brightness".
    static std::string_view name_of(int entity, int selector);

private:
    Reply refuse(int reason);
    bool held_by_automatism(int entity, int selector) const;

    std::map<std::pair<int, int>, std::int32_t> values_;
    int last_error_ = 0;
};

} // namespace dicot::usbip
