// Sentences with figures in them.
#pragma once

#include <string>

namespace dicot::calibration {

/// printf into a string; what is longer than 300 bytes is cut.
std::string text(const char* format, ...) __attribute__((format(printf, 1, 2)));

} // namespace dicot::calibration
