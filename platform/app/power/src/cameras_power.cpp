#include "dicot/power/cameras_power.h"

namespace dicot::app {

Status CamerasPower::use(const char* left_port, const char* right_port) noexcept
{
    const std::array<const char*, 2> names{left_port, right_port};
    for (std::size_t side = 0; side < ports_.size(); ++side) {
        if (ports_[side] && std::string_view{ports_[side]->port()} == names[side])
            continue;
        ports_[side] = TRY(UsbPower::at(names[side], sys_.c_str()));
    }
    return {};
}

Status CamerasPower::once(const Status& why) noexcept
{
    if (why.ok() || told_.view() == ShortText<255>{why.message()}.view())
        return {};
    told_ = why.message();
    return why;
}

Status CamerasPower::off() noexcept
{
    if (way_ == CamerasBetween::kPort)
        return switch_off();
    Status first;
    for (std::optional<UsbPower>& port : ports_) {
        if (!port)
            continue;
        const Status done = way_ == CamerasBetween::kOn ? port->keep_on() : port->let_sleep(kIdleMs);
        if (first.ok())
            first = done;
    }
    return once(first);
}

Status CamerasPower::switch_off() noexcept
{
    for (std::optional<UsbPower>& port : ports_) {
        if (!port)
            continue;
        if (const Status can = port->can_switch(); !can.ok()) {
            (void)switch_on();
            way_ = CamerasBetween::kAuto;
            (void)off();
            return once(can);
        }
    }
    Status first;
    for (std::optional<UsbPower>& port : ports_) {
        const Status done = port ? port->off() : Status{};
        if (first.ok())
            first = done;
    }
    are_on_ = false;
    return once(first);
}

Status CamerasPower::switch_on() noexcept
{
    Status first;
    for (std::optional<UsbPower>& port : ports_) {
        const Status done = port ? port->on() : Status{};
        if (first.ok())
            first = done;
    }
    return first;
}

Status CamerasPower::on() noexcept
{
    // The first time too: who was here before may have been cut off while they were off.
    if (way_ != CamerasBetween::kPort || are_on_)
        return {};
    const Status switched = once(switch_on());
    for (const std::optional<UsbPower>& port : ports_)
        if (port && switched.ok())
            TRY(wait_for_device(port->port(), kAppearMs, sys_.c_str()));
    are_on_ = true;
    return switched;
}

} // namespace dicot::app
