// A digest as bytes and as text.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/os/sha256.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace dicot {

using DigestBytes = std::array<std::byte, 32>;

ShortText<64> digest_text(const DigestBytes& digest);
/// Of 64 lower-case hexadecimal digits.
DigestBytes digest_bytes(const ShortText<64>& text);

} // namespace dicot
