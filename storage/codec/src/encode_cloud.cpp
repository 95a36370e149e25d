#include "dicot/codec/encode_cloud.h"

#include "cloud_encoder.h"
#include "dicot/os/lent_heap.h"
#include "meta_entries.h"
#include "packed_points.h"

#include <draco/core/quantization_utils.h>
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

// Two moments can be the fullest, each measured with clouds that fill it and rounded up
// (tests/storage/codec_memory_test.cpp). Beside the file and two rows of three numbers a point there are either the
// tables of an entropy coder, as large as the differences are, or a third row, when differences are written bit by bit.
constexpr std::size_t kTableBytesPerPoint = 38;
constexpr std::size_t kTableBytesFixed = std::size_t{6} << 20;
constexpr std::size_t kRowsBytesPerPoint = 50;
constexpr std::size_t kRowsBytesFixed = std::size_t{1} << 20;
// Room for the file from the start, or growing would hold it twice: random points on 20 bits take 10.5 bytes, and the
// entropy coder asks for twice what it expects to fill: for positions on 18 bits 13.5.
constexpr std::size_t kFileBytesPerPoint = 14;
constexpr std::size_t kFileBytesFixed = std::size_t{64} << 10;

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
    return cloud.AddAttribute(attribute, true, 0);
}

void name(draco::PointCloud& cloud, int attribute, const char* as)
{
    auto named = std::make_unique<draco::AttributeMetadata>();
    named->AddEntryString("name", as);
    cloud.AddAttributeMetadata(attribute, std::move(named));
}

void describe(draco::PointCloud& into, const PointCloud& cloud, const CloudMeta& meta)
{
    const MetaEntries known = entries_of(meta, cloud.grid);
    for (int i = 0; i < known.count; ++i)
        into.metadata()->AddEntryString(known.entries[i].key, known.entries[i].text.c_str());
}

/// False: Draco refused.
bool pack(const PointCloud& cloud, const CloudMeta& meta, std::span<const std::uint16_t> leaf,
          draco::EncoderBuffer& out)
{
    draco::PointCloud described; // attributes that are added before it has points take no memory for values
    add_attribute(described, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, false);
    add_attribute(described, draco::GeometryAttribute::COLOR, draco::DT_UINT8, 3, true);
    const int confidence = add_attribute(described, draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, 1, false);
    name(described, confidence, "confidence");
    if (!leaf.empty())
        name(described, add_attribute(described, draco::GeometryAttribute::GENERIC, draco::DT_UINT16, 1, false),
             "leaf");
    described.set_num_points(static_cast<std::uint32_t>(cloud.points.size()));
    describe(described, cloud, meta);
    return CloudEncoder(described, cloud, leaf).Encode(draco::EncoderOptions::CreateDefaultOptions(), &out).ok();
}

/// The decoded values of one attribute beside the points that were meant.
class Comparison
{
public:
    Comparison(const PointCloud& cloud, std::span<const std::uint16_t> leaf, CloudProof& proof)
        : cloud_(cloud), leaf_(leaf), proof_(proof)
    {
        const Quantisation grid = position_quantisation(cloud.grid);
        std::copy_n(grid.least, kMostComponents, origin_m_);
        (void)metres_.Init(grid.range, (1 << grid.bits) - 1);
    }

    bool operator()(Part part, std::span<const std::int32_t> values) const
    {
        for (std::size_t i = 0; i < cloud_.points.size(); ++i) {
            const std::int32_t* read = values.data() + i * components_of(part);
            const CloudPoint& meant = cloud_.points[i];
            const bool same = part == Part::kPosition ? same_place(meant, read)
                              : part == Part::kColour ? read[0] == stored_channel(meant.colour.r) &&
                                                            read[1] == stored_channel(meant.colour.g) &&
                                                            read[2] == stored_channel(meant.colour.b)
                              : part == Part::kLeaf ? read[0] == leaf_[i]
                                                    : read[0] == stored_confidence(meant.confidence);
            if (!same)
                return false;
        }
        return true;
    }

private:
    /// As integers, and as the float32 that a reader makes of them.
    bool same_place(const CloudPoint& meant, const std::int32_t* read) const
    {
        const double step_m = cloud_.grid.step_um * 1e-6;
        const std::int32_t steps[3] = {meant.x, meant.y, meant.z};
        bool same = true;
        for (int axis = 0; axis < 3; ++axis) {
            const float metres = metres_(read[axis]) + origin_m_[axis];
            const double off_m = std::fabs(static_cast<double>(metres) - steps[axis] * step_m);
            proof_.worst_error_um = std::max(proof_.worst_error_um, off_m * 1e6);
            proof_.least[axis] = std::min(proof_.least[axis], steps[axis]);
            proof_.most[axis] = std::max(proof_.most[axis], steps[axis]);
            same = same && read[axis] == steps[axis] - cloud_.grid.origin[axis] && off_m < step_m / 2;
        }
        return same;
    }

    const PointCloud& cloud_;
    std::span<const std::uint16_t> leaf_;
    CloudProof& proof_;
    draco::Dequantizer metres_;
    float origin_m_[kMostComponents] = {};
};

Result<CloudProof> prove(const PointCloud& cloud, std::span<const std::uint16_t> leaf, std::span<const std::byte> file)
{
    const Result<CloudOutline> read = outline_of(file, "the encoded cloud");
    if (!read.ok() || read.value().points != cloud.points.size() || read.value().grid != cloud.grid ||
        read.value().has_leaves == leaf.empty())
        return failure(Fault::kSoftware, "the encoded cloud is announced as another one: report this");
    CloudProof proof;
    proof.points = static_cast<std::uint32_t>(cloud.points.size());
    const CloudPoint& first = cloud.points[0];
    for (std::int32_t* bounds : {proof.least, proof.most}) {
        bounds[0] = first.x;
        bounds[1] = first.y;
        bounds[2] = first.z;
    }
    int confidence_bits = 0;
    if (!unpack(file, read.value(), confidence_bits, Comparison(cloud, leaf, proof)) ||
        confidence_bits != kConfidenceBits)
        return failure(Fault::kSoftware, "the encoded cloud decodes to another one: report this");
    return proof;
}

} // namespace

std::size_t encode_heap_bytes(std::size_t points)
{
    return std::max(kTableBytesFixed + points * kTableBytesPerPoint, kRowsBytesFixed + points * kRowsBytesPerPoint);
}

Result<EncodedCloud> encode_cloud(const PointCloud& cloud, const CloudMeta& meta, std::span<std::byte> heap,
                                  std::span<const std::uint16_t> leaf)
{
    TRY(check(cloud));
    if (!leaf.empty() && leaf.size() != cloud.points.size())
        return failure(Fault::kSoftware, "%zu leaves of %zu points: report this", leaf.size(), cloud.points.size());
    draco::EncoderBuffer file; // its bytes lie in the lent heap, and are moved to its start when nothing else does
    EncodedCloud encoded;
    {
        LentHeap lent{heap};
        try {
            file.buffer()->reserve(kFileBytesFixed + cloud.points.size() * kFileBytesPerPoint +
                                   leaf.size() * kLeafHeapBytes);
            if (!pack(cloud, meta, leaf, file))
                return failure(Fault::kSoftware, "the compressor refuses the cloud: report this");
            encoded.proof = TRY(prove(cloud, leaf, std::as_bytes(std::span{file.data(), file.size()})));
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
