// The sections [power] and [watchdog] of the configuration as rules.
#pragma once

#include "dicot/power/cameras_power.h"
#include "dicot/power/rest.h"

namespace dicot::app {

struct Config;

RestRules rest_rules(const Config& config);
CamerasBetween cameras_between(const Config& config);

} // namespace dicot::app
