// Decoded Draco points, checked to be what storage/FORMAT.md says.
#pragma once

#include "dicot/base/image.h"

#include <draco/compression/decode.h>

#include <cstddef>
#include <memory>
#include <span>
#include <utility>

namespace dicot {

struct PlainPoint
{
    float metres[3];
    Rgb8 colour;
    float confidence;
};

class DracoPoints
{
public:
    /// Decodes `file`; empty when it is damaged or has not exactly `count` points of the three attributes.
    static DracoPoints unpack(std::span<const std::byte> file, std::size_t count)
    {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(file.data()), file.size());
        draco::Decoder decoder;
        auto decoded = decoder.DecodePointCloudFromBuffer(&buffer);
        if (!decoded.ok())
            return {};
        DracoPoints points;
        points.cloud_ = std::move(decoded).value();
        points.position_ = points.attribute(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, count);
        points.colour_ = points.attribute(draco::GeometryAttribute::COLOR, draco::DT_UINT8, 3, count);
        points.confidence_ = points.attribute(draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, 1, count);
        if (points.cloud_->num_points() != count || !points.position_ || !points.colour_ || !points.confidence_)
            return {};
        return points;
    }

    explicit operator bool() const { return cloud_ != nullptr; }

    PlainPoint at(std::size_t index) const
    {
        const draco::PointIndex point(static_cast<std::uint32_t>(index));
        PlainPoint plain{};
        position_->GetMappedValue(point, plain.metres);
        colour_->GetMappedValue(point, &plain.colour);
        confidence_->GetMappedValue(point, &plain.confidence);
        return plain;
    }

private:
    const draco::PointAttribute* attribute(draco::GeometryAttribute::Type type, draco::DataType data, int components,
                                           std::size_t count) const
    {
        const draco::PointAttribute* found = cloud_->GetNamedAttribute(type);
        const bool ours = found != nullptr && found->data_type() == data && found->num_components() == components &&
                          found->size() == count && found->is_mapping_identity() &&
                          found->byte_stride() == components * draco::DataTypeLength(data);
        return ours ? found : nullptr;
    }

    std::unique_ptr<draco::PointCloud> cloud_;
    const draco::PointAttribute* position_ = nullptr;
    const draco::PointAttribute* colour_ = nullptr;
    const draco::PointAttribute* confidence_ = nullptr;
};

} // namespace dicot
