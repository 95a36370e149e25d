// Where the archive is, and whose folders are in it.
#pragma once

#include "../store/store_words.h"

#include <string>
#include <vector>

namespace dicot::app {

/// `given`, or dicot-clouds in the person's home: the same archive, wherever the command is started. Fault::kUsage:
/// nothing is given, and there is no home.
Result<std::string> archive_folder(const std::string& given);

/// The boards' folders in it by name, or it alone if it is one. Fault::kNoInput.
Result<std::vector<DeviceFolder>> boards_of_archive(const std::string& archive);

} // namespace dicot::app
