// The points of a file, attribute by attribute: never more than one of them is in memory.
#pragma once

#include "dicot/codec/decode_cloud.h"
#include "packing.h"
#include "value_coder.h"

#include <draco/compression/config/compression_shared.h>

#include <cstddef>
#include <span>
#include <vector>

namespace dicot {

/// The ends of a quantised attribute's values, as they stand behind all values.
inline bool read_quantisation(draco::DecoderBuffer& in, Part part, Quantisation& read)
{
    for (std::size_t axis = 0; axis < components_of(part); ++axis)
        if (!in.Decode(&read.least[axis]))
            return false;
    return in.Decode(&read.range) && in.Decode(&read.bits);
}

/// Calls take(part, values) for positions, colours, confidences and, if the outline has them, leaves, all of which it
/// must accept by `true`. Values are those of the file, in no checked range. False: the file is damaged, or not on the
/// grid of its outline.
template <typename Take>
bool unpack(std::span<const std::byte> file, const CloudOutline& outline, int& confidence_bits, const Take& take)
{
    const auto packed = file.subspan(outline.points_at);
    draco::DecoderBuffer in;
    in.Init(reinterpret_cast<const char*>(packed.data()), packed.size(), draco::kDracoPointCloudBitstreamVersion);
    std::vector<std::int32_t> values(outline.points * kMostComponents);
    for (const Part part : parts_of(outline.has_leaves)) {
        const auto those = std::span(values).first(outline.points * components_of(part));
        if (!read_values(in, those, components_of(part)) || !take(part, std::span<const std::int32_t>(those)))
            return false;
    }
    Quantisation position;
    Quantisation confidence;
    if (!read_quantisation(in, Part::kPosition, position) || !read_quantisation(in, Part::kConfidence, confidence))
        return false;
    confidence_bits = confidence.bits;
    return position == position_quantisation(outline.grid) && confidence == Quantisation{{}, 1, confidence.bits} &&
           confidence_bits >= 1 && confidence_bits <= 8;
}

} // namespace dicot
