// dicot info: what a file is and what it says about itself.
#include "cloud_on_disk.h"
#include "commands.h"

#include "dicot/export/export_cloud.h"
#include "dicot/os/input_file.h"
#include "dicot/os/shown_path.h"
#include "dicot/picture/read_picture.h"
#include "dicot/rig/rig_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace dicot::app {
namespace {

using Json = nlohmann::ordered_json;

enum class Kind
{
    kCloud,
    kPicture,
    kRig
};

/// By the first bytes; the file's name says nothing.
Result<Kind> kind_of(const char* path)
{
    InputFile file;
    TRY(file.open(path));
    std::array<std::byte, 512> start{};
    const std::size_t size = TRY(file.read(start));
    const std::string_view text{reinterpret_cast<const char*>(start.data()), size};
    if (text.starts_with("DRACO"))
        return Kind::kCloud;
    if (text.starts_with("\x89PNG") || text.starts_with("\xFF\xD8") ||
        (size > 2 && text[0] == 'P' && text[1] >= '1' && text[1] <= '6' && static_cast<unsigned char>(text[2]) <= ' '))
        return Kind::kPicture;
    const bool readable = std::none_of(text.begin(), text.end(), [](unsigned char c) { // char has no sign on ARM
        return c < ' ' && c != '\n' && c != '\r' && c != '\t';
    });
    if (size == 0 || !readable)
        return failure(Fault::kBadData,
                       "%s: neither a cloud (.drc), nor a picture (PNG, JPEG, PPM), nor a rig file (YAML): give "
                       "one of these",
                       shown_path(path));
    return Kind::kRig;
}

Json told_of(const CloudMeta& meta)
{
    Json told;
    told["unit"] = kCloudUnit;
    told["frame"] = kCloudFrame;
    const auto text = [&](const char* key, const CloudMeta::Text& value) {
        if (!value.empty())
            told[key] = value.view();
    };
    const auto number = [&](const char* key, const auto& value) {
        if (value)
            told[key] = *value;
    };
    text("captured_at", meta.captured_at);
    text("clock_trust", meta.clock_trust);
    text("device_id", meta.device_id);
    number("sequence", meta.sequence);
    text("calibration_id", meta.calibration_id);
    number("skew_us", meta.skew_us);
    number("near_mm", meta.near_mm);
    number("far_mm", meta.far_mm);
    text("software", meta.software);
    return told;
}

Result<Json> about_cloud(const char* path)
{
    const CloudOnDisk read = TRY(CloudOnDisk::read(path));
    const auto points = read.cloud().points;
    const CloudGrid& grid = read.cloud().grid;
    CloudPoint least = points[0];
    CloudPoint most = points[0];
    std::int64_t confidence = 0;
    for (const CloudPoint& point : points) {
        least.x = std::min(least.x, point.x);
        least.y = std::min(least.y, point.y);
        least.z = std::min(least.z, point.z);
        most.x = std::max(most.x, point.x);
        most.y = std::max(most.y, point.y);
        most.z = std::max(most.z, point.z);
        confidence += point.confidence;
    }
    const auto mm = [&](const CloudPoint& point) {
        const double step_mm = grid.step_um / 1e3;
        return Json{point.x * step_mm, point.y * step_mm, point.z * step_mm};
    };
    const double count = static_cast<double>(points.size());
    return Json{{"file", path},
                {"kind", "cloud"},
                {"points", points.size()},
                {"bytes", read.file_bytes()},
                {"bits_per_point", 8.0 * static_cast<double>(read.file_bytes()) / count},
                {"times_smaller_than_ply",
                 static_cast<double>(kPlyBytesPerPoint) * count / static_cast<double>(read.file_bytes())},
                {"least_mm", mm(least)},
                {"most_mm", mm(most)},
                {"mean_confidence", static_cast<double>(confidence) / 255.0 / count},
                {"grid", {{"step_mm", grid.step_um / 1e3}, {"bits", grid.bits}}},
                {"meta", told_of(read.meta())}};
}

Result<Json> about_picture(const char* path)
{
    const PictureSize size = TRY(picture_size(path));
    return Json{{"file", path}, {"kind", "picture"}, {"width", size.width}, {"height", size.height}};
}

Result<Json> about_rig(const char* path)
{
    const RigFile rig = TRY(read_rig_file(path));
    Json about{{"file", path}, {"kind", "rig"}, {"width", rig.width}, {"height", rig.height}};
    if (rig.id[0] != '\0')
        about["id"] = rig.id;
    if (rig.near_mm)
        about["near_mm"] = *rig.near_mm;
    if (rig.far_mm)
        about["far_mm"] = *rig.far_mm;
    about["calibrated"] = rig.left.intrinsic && rig.right.intrinsic && rig.rotation && rig.translation_mm;
    const Result<RigGeometry> geometry = geometry_of(rig, path);
    about["rectified"] = geometry.ok();
    if (!geometry.ok()) {
        about["not_rectified"] = geometry.status().message();
        return about;
    }
    const RigGeometry& found = geometry.value();
    about["baseline_mm"] = found.baseline_mm;
    about["focal_px"] = found.focal_px;
    about["principal_point_px"] = {found.cx_px, found.cy_px};
    about["disparity_offset_px"] = found.disparity_offset_px;
    return about;
}

Result<Json> about(const char* path)
{
    switch (TRY(kind_of(path))) {
    case Kind::kCloud:
        return about_cloud(path);
    case Kind::kPicture:
        return about_picture(path);
    case Kind::kRig:
        return about_rig(path);
    }
    return failure(Fault::kSoftware, "%s: a kind of file that nobody thought of", shown_path(path));
}

/// One line a value; what is inside another value is set in.
void print(const Json& values, int indent)
{
    for (const auto& [key, value] : values.items()) {
        if (value.is_object()) {
            std::printf("%*s%s:\n", indent, "", key.c_str());
            print(value, indent + 2);
        } else {
            const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
            std::printf("%*s%s: %s\n", indent, "", key.c_str(), text.c_str());
        }
    }
}

Status run(const std::string& path, bool json)
{
    const Json told = TRY(about(path.c_str()));
    if (json)
        std::printf("%s\n", told.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    else
        print(told, 0);
    return {};
}

} // namespace

void add_info(CLI::App& program, Command& chosen)
{
    struct Words
    {
        std::string file;
        bool json = false;
    };
    CLI::App* command = program.add_subcommand("info", "What a cloud, a rig file or a picture is");
    auto words = std::make_shared<Words>();
    command->add_option("FILE", words->file, "cloud (.drc), rig file (YAML) or picture")->required();
    command->add_flag("--json", words->json, "report as JSON");
    command->callback([words, &chosen] { chosen = [words] { return run(words->file, words->json); }; });
}

} // namespace dicot::app
