#include "config_json.h"

#include "config/config_keys.h"
#include "config/config_paths.h"

#include <nlohmann/json.hpp>

namespace dicot::app {
namespace {

using nlohmann::json;

struct JsonOf
{
    const Config& config;

    json operator()(const BindingKey& key) const { return text_of(key.reach(config)); }
    json operator()(const FormatsKey& key) const
    {
        json list = json::array();
        for (const PixelFormat format : key.reach(config))
            list.push_back(name_of(format));
        return list;
    }
    json operator()(const OpenNumberKey& key) const
    {
        const std::optional<double>& number = key.reach(config);
        return number ? json(*number) : json();
    }
    template <typename Key>
    json operator()(const Key& key) const
    {
        return key.reach(config);
    }
};

json value_of(const ConfigKey& key, const Config& config)
{
    return std::visit(JsonOf{config}, key.kind);
}

} // namespace

nlohmann::json config_values(const Config& config)
{
    json values = json::object();
    for (const ConfigKey& key : config_keys())
        values[key.section][key.name] = value_of(key, config);
    return values;
}

std::string config_json(const LoadedConfig& loaded, const std::string& here)
{
    const Config config = all_taken_from(here, loaded.config);
    json report = {{"file", loaded.file.empty() ? json() : json(loaded.file)}, {"sections", json::object()}};
    std::size_t place = 0;
    for (const ConfigKey& key : config_keys()) {
        const int line = loaded.lines[place++];
        report["sections"][key.section][key.name] = {{"value", value_of(key, config)},
                                                     {"from", line == 0 ? "default" : "file"},
                                                     {"line", line == 0 ? json() : json(line)},
                                                     {"default", value_of(key, Config{})},
                                                     {"unit", *key.unit == '\0' ? json() : json(key.unit)},
                                                     {"allowed", allowed_of(key)},
                                                     {"meaning", key.meaning}};
    }
    return report.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

} // namespace dicot::app
