// What is known of the computer itself.
#pragma once

#include <string>
#include <vector>

namespace dicot {

/// Its name; empty if it has none.
std::string host_name();

struct Temperature
{
    std::string name; ///< "thermal/cpu-thermal", "hwmon/coretemp/Package id 0": printable ASCII, each name once
    double celsius = 0;
};

/// Of all sensors below `sys` (class/thermal, class/hwmon) that answer with -100 to 300 degrees, at most 64, in the
/// order of their folders. None: there are no sensors, as in most virtual machines.
std::vector<Temperature> read_temperatures(const std::string& sys = "/sys");

} // namespace dicot
