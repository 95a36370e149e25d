#include "../traits/trait_columns.h"
#include "plant_report.h"

#include <nlohmann/json.hpp>

#include <string_view>

namespace dicot::app {

using nlohmann::json;

namespace {

/// As PlantCV calls it.
const char* scale_of(std::string_view name)
{
    constexpr std::pair<std::string_view, const char*> kScales[] = {{"_per_m", "per meter"},
                                                                    {"_mm", "millimeters"},
                                                                    {"_mm2", "square millimeters"},
                                                                    {"_mm3", "cubic millimeters"},
                                                                    {"_deg", "degrees"}};
    for (const auto& [ending, scale] : kScales)
        if (name.ends_with(ending))
            return scale;
    return "none";
}

/// A NaN becomes null.
json observation(const char* name, const std::string& words, const Measured& measured)
{
    return {{"trait", words},          {"method", std::string{"dicot.plant."} + name},
            {"scale", scale_of(name)}, {"datatype", "<class 'float'>"},
            {"value", measured.value}, {"sd", measured.sd},
            {"label", scale_of(name)}};
}

json flag(const char* name, const char* words, bool value)
{
    return {{"trait", words},  {"method", std::string{"dicot.plant."} + name},
            {"scale", "none"}, {"datatype", "<class 'bool'>"},
            {"value", value},  {"label", "none"}};
}

/// "leaf length mm" of "leaf_length_mm".
std::string spelled(std::string name)
{
    for (char& c : name)
        c = c == '_' ? ' ' : c;
    return name;
}

json plant_sample(const PlantTraits& plant)
{
    json sample;
    for (const PlantColumn& column : plant_columns())
        sample[column.name] = observation(column.name, column.words, plant.*column.measured);
    sample["greenness"] = observation("greenness", "mean of (2 g - r - b) / (r + g + b)", {plant.greenness, 0});
    sample["cut"] = flag("cut", "leaves the picture or the working range", plant.cut);
    return sample;
}

json leaf_sample(const LeafTraits& leaf)
{
    json sample;
    for (const LeafColumn& column : leaf_columns())
        sample[column.name] = observation(column.name, spelled(column.name), leaf.*column.measured);
    sample["greenness"] = observation("greenness", "mean of (2 g - r - b) / (r + g + b)", {leaf.greenness, 0});
    sample["hidden"] = flag("hidden", "something in front covers a part", leaf.hidden);
    sample["cut"] = flag("cut", "leaves the picture or the working range", leaf.cut);
    return sample;
}

json told(const char* label, const char* datatype, const json& value)
{
    return {{"label", label}, {"datatype", datatype}, {"value", value}};
}

json metadata_of(const PlantReport& report)
{
    constexpr const char *kText = "<class 'str'>", *kWhole = "<class 'int'>", *kNumber = "<class 'float'>";
    const PlantWork& work = report.work;
    const GroundFrame& ground = work.leaves().ground;
    const bool known = ground.kind != GroundFrame::Kind::kNone;
    json all = {{"cloud", told("cloud file", kText, report.cloud)},
                {"points", told("points of the cloud", kWhole, work.view().cloud.points.size())},
                {"ground", told("what heights are above", kText,
                                !known                                    ? "none"
                                : ground.kind == GroundFrame::Kind::kSoil ? "soil"
                                                                          : "bench")},
                {"ground_frame", told("origin in mm, right, away, up in the camera's frame", "<class 'list'>",
                                      {ground.origin_mm, ground.right, ground.away, ground.up})},
                {"memory_bytes", told("memory taken at most", kWhole, work.memory_bytes())},
                {"grid_s", told("seconds: grid", kNumber, work.times().view_s)},
                {"leaves_s", told("seconds: ground, canopy, leaves", kNumber, work.times().leaves_s)},
                {"traits_s", told("seconds: traits", kNumber, work.times().traits_s)}};
    const CloudMeta& meta = report.meta;
    if (!meta.captured_at.empty())
        all["timestamp"] = told("datetime of image", "<class 'datetime.datetime'>", meta.captured_at.view());
    if (!meta.device_id.empty())
        all["camera"] = told("camera identifier", kText, meta.device_id.view());
    if (meta.sequence)
        all["id"] = told("image identifier", kText, std::to_string(*meta.sequence));
    return all;
}

} // namespace

json plant_json(const PlantReport& report)
{
    json observations = json::object(), names = json::object();
    for (const PlantTraits& plant : report.work.traits().plants) {
        const std::string sample = "plant_" + std::to_string(plant.plant);
        names[sample] = report.work.plant_name(plant.plant);
        observations[sample] = plant_sample(plant);
    }
    for (const LeafTraits& leaf : report.work.traits().leaves)
        observations["plant_" + std::to_string(leaf.plant) + "_leaf_" + std::to_string(leaf.leaf)] = leaf_sample(leaf);
    json metadata = metadata_of(report);
    metadata["plant_names"] = told("names of the plants", "<class 'dict'>", names);
    return {{"metadata", metadata}, {"observations", observations}};
}

} // namespace dicot::app
