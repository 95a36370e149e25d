// The map `quality` of a rig file.
#pragma once

#include "yaml_events.h"

#include "dicot/rig/rig_file.h"

#include <array>
#include <string_view>

namespace dicot {

struct QualityNumber
{
    const char* key;
    double* at;
};

/// All of them but the count of pairs, in the file's order.
std::array<QualityNumber, 10> numbers_of(RigQuality& quality);

/// Reads the map at the current event: every key once, no number below 0. Others are passed over.
Result<RigQuality> read_quality(YamlEvents& events, std::string_view key);

} // namespace dicot
