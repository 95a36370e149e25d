#include "dicot/power/power_rules.h"

#include "config/config.h"

namespace dicot::app {

RestRules rest_rules(const Config& config)
{
    RestRules rules;
    rules.between = config.power.between == "off"       ? Between::kOff
                    : config.power.between == "suspend" ? Between::kSuspend
                                                        : Between::kIdle;
    rules.least_rest_us = std::int64_t{config.power.least_rest_s} * 1'000'000;
    if (config.usb.export_store) // its gadget is made, and a computer that is there looks at it
        rules.awake_first_us = 60'000'000;
    rules.state = std::string_view{config.run.state};
    return rules;
}

CamerasBetween cameras_between(const Config& config)
{
    return config.power.cameras == "port" ? CamerasBetween::kPort
           : config.power.cameras == "on" ? CamerasBetween::kOn
                                          : CamerasBetween::kAuto;
}

} // namespace dicot::app
