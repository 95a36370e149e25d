#include "leaf_cloud.h"

#include "dicot/codec/encode_cloud.h"
#include "dicot/export/export_cloud.h"
#include "dicot/os/output_file.h"
#include "dicot/os/shown_path.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace dicot::app {
namespace {

Status write_drc(const std::string& path, const PointCloud& cloud, const CloudMeta& meta,
                 std::span<const std::uint16_t> leaf)
{
    const MemoryBlock heap =
        TRY(MemoryBlock::map(encode_heap_bytes(cloud.points.size()) + leaf.size() * kLeafHeapBytes));
    const EncodedCloud encoded = TRY(encode_cloud(cloud, meta, heap.bytes(), leaf));
    OutputFile file;
    TRY(file.open(path.c_str()));
    TRY(file.write(encoded.bytes));
    return file.commit();
}

Rgb8 grey(const Rgb8& colour)
{
    const auto level = static_cast<std::uint8_t>((colour.r * 3 + colour.g * 6 + colour.b) / 20 + 40);
    return {level, level, level};
}

} // namespace

Rgb8 leaf_colour(int leaf)
{
    // The golden angle: each hue lies in the widest gap that the ones before it left.
    const double hue = std::fmod(leaf * 137.508, 360.0) / 60, level = leaf % 3 == 0 ? 0.75 : 1.0;
    const auto channel = [&](double turn) {
        const double at = std::fmod(hue + turn, 6.0);
        const double full = at < 1 ? at : at < 3 ? 1 : at < 4 ? 4 - at : 0;
        return static_cast<std::uint8_t>(level * (40 + 215 * full));
    };
    return {channel(2), channel(0), channel(4)};
}

Status write_leaf_cloud(const std::string& path, const PlantWork& work, const CloudMeta& meta)
{
    const PointCloud& cloud = work.view().cloud;
    const Leaves& leaves = work.leaves();
    std::vector<CloudPoint> points(cloud.points.begin(), cloud.points.end());
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i].colour = leaves.leaf[i] != Leaves::kNone ? leaf_colour(leaves.leaf[i]) : grey(points[i].colour);
    const PointCloud coloured{points, cloud.grid};
    if (path.ends_with(".drc"))
        return write_drc(path, coloured, meta, leaves.leaf);
    if (path.ends_with(".ply"))
        return write_ply(path.c_str(), coloured, meta, {leaves.leaf, leaves.plant});
    return failure(Fault::kUsage, "%s: the name must end in .drc or .ply", shown_path(path.c_str()));
}

} // namespace dicot::app
