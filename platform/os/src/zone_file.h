// Zone files of the IANA database.
#pragma once

#include "dicot/os/time_zone.h"

#include <cstddef>
#include <span>

namespace dicot {

/// A file as RFC 8536 has it, versions 1 to 4, into a table of what holds from 1970 on. Null: read; else what is wrong
/// with it, in words that follow on its name.
const char* read_zone_file(std::span<const std::byte> bytes, ZoneTable& table) noexcept;

} // namespace dicot
