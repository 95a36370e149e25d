// Draco's sequential encoder, fed from our points: it holds no copy of them, only the attribute that is being packed.
#pragma once

#include "dicot/codec/stored_point.h"
#include "packing.h"
#include "value_coder.h"

#include <draco/compression/point_cloud/point_cloud_sequential_encoder.h>
#include <draco/point_cloud/point_cloud.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace dicot {

/// Writes the bytes that draco::PointCloudSequentialEncoder writes for the same values. `described` has the
/// attributes, empty, and the metadata; `leaf` is empty, or has a number for each point.
class CloudEncoder final : public draco::PointCloudSequentialEncoder
{
public:
    CloudEncoder(const draco::PointCloud& described, const PointCloud& cloud, std::span<const std::uint16_t> leaf)
        : cloud_(cloud), leaf_(leaf)
    {
        SetPointCloud(described);
    }

private:
    class Attributes final : public draco::AttributesEncoder
    {
    public:
        Attributes(const PointCloud& cloud, std::span<const std::uint16_t> leaf, std::int32_t first)
            : AttributesEncoder(first), cloud_(cloud), leaf_(leaf)
        {
        }

        std::uint8_t GetUniqueId() const override { return draco::BASIC_ATTRIBUTE_ENCODER; }
        bool EncodeAttributesEncoderData(draco::EncoderBuffer* out) override
        {
            if (!AttributesEncoder::EncodeAttributesEncoderData(out))
                return false;
            for (const Part part : parts_of(!leaf_.empty()))
                out->Encode(static_cast<std::uint8_t>(part == Part::kColour || part == Part::kLeaf
                                                          ? draco::SEQUENTIAL_ATTRIBUTE_ENCODER_INTEGER
                                                          : draco::SEQUENTIAL_ATTRIBUTE_ENCODER_QUANTIZATION));
            return true;
        }

    private:
        bool EncodePortableAttributes(draco::EncoderBuffer* out) override
        {
            std::vector<std::int32_t> values(cloud_.points.size() * kMostComponents);
            for (const Part part : parts_of(!leaf_.empty())) {
                const auto those = std::span(values).first(cloud_.points.size() * components_of(part));
                fill(part, those);
                if (!write_values(those, components_of(part), *out))
                    return false;
            }
            return true;
        }

        bool EncodeDataNeededByPortableTransforms(draco::EncoderBuffer* out) override
        {
            write(Part::kPosition, position_quantisation(cloud_.grid), *out);
            write(Part::kConfidence, {{}, 1, kConfidenceBits}, *out);
            return true;
        }

        void fill(Part part, std::span<std::int32_t> values) const
        {
            if (part == Part::kLeaf) {
                std::ranges::copy(leaf_, values.begin());
                return;
            }
            std::int32_t* at = values.data();
            for (const CloudPoint& point : cloud_.points) {
                if (part == Part::kPosition) {
                    *at++ = point.x - cloud_.grid.origin[0];
                    *at++ = point.y - cloud_.grid.origin[1];
                    *at++ = point.z - cloud_.grid.origin[2];
                } else if (part == Part::kColour) {
                    *at++ = stored_channel(point.colour.r);
                    *at++ = stored_channel(point.colour.g);
                    *at++ = stored_channel(point.colour.b);
                } else {
                    *at++ = stored_confidence(point.confidence);
                }
            }
        }

        static void write(Part part, const Quantisation& quantisation, draco::EncoderBuffer& out)
        {
            for (std::size_t axis = 0; axis < components_of(part); ++axis)
                out.Encode(quantisation.least[axis]);
            out.Encode(quantisation.range);
            out.Encode(quantisation.bits);
        }

        const PointCloud& cloud_;
        std::span<const std::uint16_t> leaf_;
    };

    bool GenerateAttributesEncoder(std::int32_t id) override
    {
        if (num_attributes_encoders() == 0)
            AddAttributesEncoder(std::make_unique<Attributes>(cloud_, leaf_, id));
        else
            attributes_encoder(0)->AddAttributeId(id);
        return true;
    }

    const PointCloud& cloud_;
    std::span<const std::uint16_t> leaf_;
};

} // namespace dicot
