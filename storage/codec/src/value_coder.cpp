#include "value_coder.h"

#include <draco/compression/attributes/prediction_schemes/prediction_scheme_delta_decoder.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_delta_encoder.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_wrap_decoding_transform.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_wrap_encoding_transform.h>
#include <draco/compression/config/compression_shared.h>
#include <draco/compression/entropy/symbol_decoding.h>
#include <draco/compression/entropy/symbol_encoding.h>
#include <draco/core/bit_utils.h>

namespace dicot {
namespace {

using Differences =
    draco::PredictionSchemeDeltaEncoder<std::int32_t, draco::PredictionSchemeWrapEncodingTransform<std::int32_t>>;
using Sums =
    draco::PredictionSchemeDeltaDecoder<std::int32_t, draco::PredictionSchemeWrapDecodingTransform<std::int32_t>>;

// Draco's speed 5. More gains 0.4 % at most, and takes larger tables here and in every reader.
constexpr int kLevel = 5;
constexpr std::uint8_t kIsEntropyCoded = 1;

std::uint32_t* symbols_in(std::span<std::int32_t> values)
{
    return reinterpret_cast<std::uint32_t*>(values.data());
}

} // namespace

bool write_values(std::span<std::int32_t> values, std::size_t components, draco::EncoderBuffer& out)
{
    const int count = static_cast<int>(values.size());
    const int width = static_cast<int>(components);
    out.Encode(static_cast<std::int8_t>(draco::PREDICTION_DIFFERENCE));
    out.Encode(static_cast<std::int8_t>(draco::PREDICTION_TRANSFORM_WRAP));
    Differences differences(nullptr);
    if (!differences.ComputeCorrectionValues(values.data(), values.data(), count, width, nullptr))
        return false;
    draco::ConvertSignedIntsToSymbols(values.data(), count, symbols_in(values));
    out.Encode(kIsEntropyCoded);
    draco::Options options;
    draco::SetSymbolEncodingCompressionLevel(&options, kLevel);
    return draco::EncodeSymbols(symbols_in(values), count, width, &options, &out) &&
           differences.EncodePredictionData(&out);
}

bool read_values(draco::DecoderBuffer& in, std::span<std::int32_t> values, std::size_t components)
{
    const int count = static_cast<int>(values.size());
    const int width = static_cast<int>(components);
    std::int8_t prediction = 0;
    std::int8_t transform = 0;
    std::uint8_t entropy_coded = 0;
    if (!in.Decode(&prediction) || prediction != draco::PREDICTION_DIFFERENCE || !in.Decode(&transform) ||
        transform != draco::PREDICTION_TRANSFORM_WRAP || !in.Decode(&entropy_coded) || entropy_coded != kIsEntropyCoded)
        return false;
    Sums sums(nullptr);
    if (!draco::DecodeSymbols(static_cast<std::uint32_t>(count), width, &in, symbols_in(values)))
        return false;
    draco::ConvertSymbolsToSignedInts(symbols_in(values), count, values.data());
    return sums.DecodePredictionData(&in) &&
           sums.ComputeOriginalValues(values.data(), values.data(), count, width, nullptr);
}

} // namespace dicot
