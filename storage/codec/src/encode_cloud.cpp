#include "dicot/codec/encode_cloud.h"

#include "dicot/os/lent_heap.h"
#include "draco_points.h"
#include "meta_entries.h"
#include "thrifty_encoder.h"

#include <draco/compression/expert_encode.h>
#include <draco/metadata/geometry_metadata.h>
#include <draco/point_cloud/point_cloud.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <new>

namespace dicot {
namespace {

// Measured with uniformly random points, which compress worst, and rounded up (tests/storage/codec_memory_test.cpp).
constexpr std::size_t kEncodeBytesPerPoint = 108;
constexpr std::size_t kEncodeBytesFixed = std::size_t{9} << 19;
// Slower settings gain 0.4 % of the size, faster ones lose 0.6 %.
constexpr int kSpeed = 5;
constexpr int kConfidenceBits = 8;
// Room for the file from the start, or growing would hold it twice: random points on 20 bits take 11.6 bytes, and the
// entropy coder asks for twice what it expects to fill.
constexpr std::size_t kFileBytesPerPoint = 16;
constexpr std::size_t kFileBytesFixed = std::size_t{64} << 10;

float metres_of(std::int64_t steps, const CloudGrid& grid)
{
    return static_cast<float>(static_cast<double>(steps) * (grid.step_um * 1e-6));
}

Status check(const PointCloud& cloud)
{
    const CloudGrid& grid = cloud.grid;
    if (cloud.points.empty())
        return failure(Fault::kBadData, "the cloud has no points: nothing was matched within the working range; "
                                        "check the working range (near_mm, far_mm), and the light");
    if (cloud.points.size() > kMaxCloudPoints)
        return failure(Fault::kConfig, "the cloud has %zu points, and a file holds %zu at most: use smaller pictures",
                       cloud.points.size(), kMaxCloudPoints);
    const std::int64_t last = (std::int64_t{1} << grid.bits) - 1;
    for (const CloudPoint& point : cloud.points) {
        const std::int32_t at[3] = {point.x, point.y, point.z};
        for (int axis = 0; axis < 3; ++axis) {
            const std::int64_t index = std::int64_t{at[axis]} - grid.origin[axis];
            if (index < 0 || index > last)
                return failure(Fault::kSoftware, "a point of the cloud lies outside its grid: report this");
        }
    }
    return {};
}

int add_attribute(draco::PointCloud& cloud, draco::GeometryAttribute::Type type, draco::DataType data, int components,
                  bool normalised)
{
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, static_cast<std::uint8_t>(components), data, normalised,
                   components * draco::DataTypeLength(data), 0);
    return cloud.AddAttribute(attribute, true, cloud.num_points());
}

void describe(draco::PointCloud& into, const PointCloud& cloud, const CloudMeta& meta, int confidence_id)
{
    auto named = std::make_unique<draco::AttributeMetadata>();
    named->AddEntryString("name", "confidence");
    into.AddAttributeMetadata(confidence_id, std::move(named));
    const MetaEntries known = entries_of(meta, cloud.grid);
    for (int i = 0; i < known.count; ++i)
        into.metadata()->AddEntryString(known.entries[i].key, known.entries[i].text.c_str());
}

/// False: Draco refused.
bool pack(const PointCloud& cloud, const CloudMeta& meta, draco::EncoderBuffer& out)
{
    const CloudGrid& grid = cloud.grid;
    draco::PointCloud points;
    points.set_num_points(static_cast<std::uint32_t>(cloud.points.size()));
    const int position = add_attribute(points, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, false);
    const int colour = add_attribute(points, draco::GeometryAttribute::COLOR, draco::DT_UINT8, 3, true);
    const int confidence = add_attribute(points, draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, 1, false);
    for (std::uint32_t i = 0; i < points.num_points(); ++i) {
        const CloudPoint& point = cloud.points[i];
        const draco::AttributeValueIndex value(i);
        const float metres[3] = {metres_of(point.x, grid), metres_of(point.y, grid), metres_of(point.z, grid)};
        const float certainty = static_cast<float>(point.confidence) / 255.0F;
        points.attribute(position)->SetAttributeValue(value, metres);
        points.attribute(colour)->SetAttributeValue(value, &point.colour);
        points.attribute(confidence)->SetAttributeValue(value, &certainty);
    }
    describe(points, cloud, meta, confidence);

    draco::ExpertEncoder settings(points);
    settings.SetSpeedOptions(kSpeed, kSpeed);
    const float origin[3] = {metres_of(grid.origin[0], grid), metres_of(grid.origin[1], grid),
                             metres_of(grid.origin[2], grid)};
    settings.SetAttributeExplicitQuantization(position, grid.bits, 3, origin,
                                              metres_of((std::int64_t{1} << grid.bits) - 1, grid));
    const float zero = 0;
    settings.SetAttributeExplicitQuantization(confidence, kConfidenceBits, 1, &zero, 1.0F);
    return ThriftyEncoder(points).Encode(settings.options(), &out).ok();
}

Result<CloudProof> prove(const PointCloud& cloud, std::span<const std::byte> file)
{
    const DracoPoints decoded = DracoPoints::unpack(file, cloud.points.size());
    if (!decoded)
        return failure(Fault::kSoftware, "the encoded cloud cannot be decoded again: report this");
    const double step_m = cloud.grid.step_um * 1e-6;
    CloudProof proof;
    proof.points = static_cast<std::uint32_t>(cloud.points.size());
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        const CloudPoint& meant = cloud.points[i];
        const PlainPoint read = decoded.at(i);
        const std::int32_t steps[3] = {meant.x, meant.y, meant.z};
        bool same = read.colour == meant.colour && std::lround(read.confidence * 255.0F) == meant.confidence;
        for (int axis = 0; axis < 3; ++axis) {
            const double off_m = std::fabs(static_cast<double>(read.metres[axis]) - steps[axis] * step_m);
            proof.worst_error_um = std::max(proof.worst_error_um, off_m * 1e6);
            same = same && off_m < step_m / 2;
            proof.least[axis] = i == 0 ? steps[axis] : std::min(proof.least[axis], steps[axis]);
            proof.most[axis] = i == 0 ? steps[axis] : std::max(proof.most[axis], steps[axis]);
        }
        if (!same)
            return failure(Fault::kSoftware, "point %zu of the encoded cloud decodes to another point: report this", i);
    }
    return proof;
}

} // namespace

std::size_t encode_heap_bytes(std::size_t points)
{
    return kEncodeBytesFixed + points * kEncodeBytesPerPoint;
}

Result<EncodedCloud> encode_cloud(const PointCloud& cloud, const CloudMeta& meta, std::span<std::byte> heap)
{
    TRY(check(cloud));
    draco::EncoderBuffer file; // its bytes lie in the lent heap, and are moved to its start when nothing else does
    EncodedCloud encoded;
    {
        LentHeap lent{heap};
        try {
            file.buffer()->reserve(kFileBytesFixed + cloud.points.size() * kFileBytesPerPoint);
            if (!pack(cloud, meta, file))
                return failure(Fault::kSoftware, "the compressor refuses the cloud: report this");
            encoded.proof = TRY(prove(cloud, std::as_bytes(std::span{file.data(), file.size()})));
        } catch (const std::bad_alloc&) {
            return failure(Fault::kConfig,
                           "%zu points do not fit the compressor's %zu KiB of memory: use smaller pictures, or "
                           "give it more",
                           cloud.points.size(), heap.size() >> 10);
        } catch (const std::exception& error) {
            return failure(Fault::kSoftware, "the compressor failed: %s", error.what());
        }
        encoded.heap_peak_bytes = lent.peak_bytes();
    }
    if (file.size() > heap.size())
        return failure(Fault::kConfig, "%zu bytes of cloud do not fit the %zu that were lent", file.size(),
                       heap.size());
    std::memmove(heap.data(), file.data(), file.size());
    encoded.bytes = heap.first(file.size());
    return encoded;
}

} // namespace dicot
