#include "dicot/export/export_cloud.h"

#include "dicot/os/output_file.h"
#include "dicot/os/shown_path.h"

#include <bit>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string_view>

namespace dicot {
namespace {

static_assert(std::endian::native == std::endian::little, "both formats are written as the numbers lie in memory");

Status put_line(OutputFile& file, const char* format, ...) __attribute__((format(printf, 2, 3)));
Status put_line(OutputFile& file, const char* format, ...)
{
    char line[256];
    va_list arguments;
    va_start(arguments, format);
    const int size = std::vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    return file.write(line, static_cast<std::size_t>(size));
}

/// "<mark> unit m" and so on, one line each.
Status put_comments(OutputFile& file, const char* mark, const CloudMeta& meta)
{
    TRY(put_line(file, "%s unit %s\n", mark, kCloudUnit));
    TRY(put_line(file, "%s frame %s\n", mark, kCloudFrame));
    const struct
    {
        const char* key;
        const CloudMeta::Text& text;
    } known[] = {{"captured_at", meta.captured_at},
                 {"clock_trust", meta.clock_trust},
                 {"device_id", meta.device_id},
                 {"calibration_id", meta.calibration_id},
                 {"software", meta.software}};
    for (const auto& [key, text] : known)
        if (!text.empty())
            TRY(put_line(file, "%s %s %s\n", mark, key, text.c_str()));
    if (meta.sequence)
        TRY(put_line(file, "%s sequence %lld\n", mark, static_cast<long long>(*meta.sequence)));
    return {};
}

struct Metres
{
    float x, y, z;
};

Metres metres_of(const CloudPoint& point, const CloudGrid& grid)
{
    const double step = grid.step_um * 1e-6;
    return {static_cast<float>(point.x * step), static_cast<float>(point.y * step), static_cast<float>(point.z * step)};
}

float certainty_of(const CloudPoint& point)
{
    return static_cast<float>(point.confidence) / 255.0F;
}

#pragma pack(push, 1)
struct PlyPoint
{
    Metres at;
    Rgb8 colour;
    float confidence;
};
#pragma pack(pop)
static_assert(sizeof(PlyPoint) == kPlyBytesPerPoint);

struct PcdPoint
{
    Metres at;
    std::uint32_t rgb; ///< 0x00RRGGBB, which PCL reads as a float of these bits
    float confidence;
};
static_assert(sizeof(PcdPoint) == 20);

} // namespace

Status write_ply(const char* path, const PointCloud& cloud, const CloudMeta& meta, const PointNumbers& numbers)
{
    OutputFile file;
    TRY(file.open(path));
    TRY(put_line(file, "ply\nformat binary_little_endian 1.0\n"));
    TRY(put_comments(file, "comment", meta));
    TRY(put_line(file,
                 "element vertex %zu\n"
                 "property float x\nproperty float y\nproperty float z\n"
                 "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                 "property float confidence\n%s"
                 "end_header\n",
                 cloud.points.size(), numbers.leaf.empty() ? "" : "property ushort leaf\nproperty uchar plant\n"));
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        const CloudPoint& point = cloud.points[i];
        const PlyPoint out{metres_of(point, cloud.grid), point.colour, certainty_of(point)};
        TRY(file.write(&out, sizeof out));
        if (numbers.leaf.empty())
            continue;
        TRY(file.write(&numbers.leaf[i], sizeof numbers.leaf[i]));
        TRY(file.write(&numbers.plant[i], sizeof numbers.plant[i]));
    }
    return file.commit();
}

Status write_pcd(const char* path, const PointCloud& cloud, const CloudMeta& meta)
{
    OutputFile file;
    TRY(file.open(path));
    TRY(put_line(file, "# .PCD v0.7 - Point Cloud Data file format\n"));
    TRY(put_comments(file, "#", meta));
    TRY(put_line(file,
                 "VERSION 0.7\nFIELDS x y z rgb confidence\nSIZE 4 4 4 4 4\nTYPE F F F F F\nCOUNT 1 1 1 1 1\n"
                 "WIDTH %zu\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %zu\nDATA binary\n",
                 cloud.points.size(), cloud.points.size()));
    for (const CloudPoint& point : cloud.points) {
        const Rgb8 c = point.colour;
        const PcdPoint out{metres_of(point, cloud.grid), std::uint32_t{c.r} << 16 | std::uint32_t{c.g} << 8 | c.b,
                           certainty_of(point)};
        TRY(file.write(&out, sizeof out));
    }
    return file.commit();
}

Status export_cloud(const char* path, const PointCloud& cloud, const CloudMeta& meta)
{
    const std::string_view name{path};
    if (name.ends_with(".ply"))
        return write_ply(path, cloud, meta);
    if (name.ends_with(".pcd"))
        return write_pcd(path, cloud, meta);
    return failure(Fault::kUsage, "%s: clouds are exported as .ply or .pcd: give the file one of these endings",
                   shown_path(path));
}

} // namespace dicot
