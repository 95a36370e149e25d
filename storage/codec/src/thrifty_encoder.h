// Draco's sequential encoder, with less memory: what has been made ready for coding is not kept twice.
#pragma once

#include <draco/compression/attributes/linear_sequencer.h>
#include <draco/compression/attributes/sequential_attribute_encoders_controller.h>
#include <draco/compression/point_cloud/point_cloud_sequential_encoder.h>
#include <draco/point_cloud/point_cloud.h>

#include <cstdint>
#include <memory>

namespace dicot {

/// Writes the bytes that draco::PointCloudSequentialEncoder writes. The values of `points` (19 bytes a point, as we set
/// them) are gone as soon as their quantised copies are made, before the entropy coder takes its memory.
class ThriftyEncoder final : public draco::PointCloudSequentialEncoder
{
public:
    explicit ThriftyEncoder(draco::PointCloud& points) : points_(points) { SetPointCloud(points); }

private:
    class Attributes final : public draco::SequentialAttributeEncodersController
    {
    public:
        Attributes(draco::PointCloud& points, std::int32_t first)
            : SequentialAttributeEncodersController(
                  std::make_unique<draco::LinearSequencer>(static_cast<std::int32_t>(points.num_points())), first),
              points_(points)
        {
        }

    private:
        bool EncodePortableAttributes(draco::EncoderBuffer* out) override
        {
            for (std::int32_t id = 0; id < points_.num_attributes(); ++id)
                *points_.attribute(id)->buffer() = draco::DataBuffer{};
            return SequentialAttributeEncodersController::EncodePortableAttributes(out);
        }

        draco::PointCloud& points_;
    };

    bool GenerateAttributesEncoder(std::int32_t id) override
    {
        if (num_attributes_encoders() == 0)
            AddAttributesEncoder(std::make_unique<Attributes>(points_, id));
        else
            attributes_encoder(0)->AddAttributeId(id);
        return true;
    }

    draco::PointCloud& points_;
};

} // namespace dicot
