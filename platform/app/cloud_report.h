// What is told of a cloud that was made, to programs and to people.
#pragma once

#include "cloud_work.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

namespace dicot::app {

/// Figures of a cloud that was encoded; `method` as in MatchWords.
nlohmann::json cloud_report(const CloudWork& work, const std::string& method, std::uint64_t peak_bytes);

/// The same in four lines on stdout.
void print_cloud_report(const CloudWork& work, const std::string& cloud, std::uint64_t peak_bytes);

} // namespace dicot::app
