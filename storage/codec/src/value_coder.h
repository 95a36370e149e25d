// Rows of whole numbers into bytes and back, in place. The bytes are those of Draco's sequential integer coder:
// differences to the point before, wrapped into the values' range, then its entropy coder.
#pragma once

#include <draco/core/decoder_buffer.h>
#include <draco/core/encoder_buffer.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// `values` holds `components` for each point, and is used up. False: Draco refused.
bool write_values(std::span<std::int32_t> values, std::size_t components, draco::EncoderBuffer& out);

/// Fills `values`. False: the bytes are damaged, or packed in another way.
bool read_values(draco::DecoderBuffer& in, std::span<std::int32_t> values, std::size_t components);

} // namespace dicot
