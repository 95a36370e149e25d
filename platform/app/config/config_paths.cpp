#include "config_paths.h"

namespace dicot::app {

std::string path_from(const std::string& folder, const std::string& path)
{
    if (folder.empty() || path.empty() || path.starts_with('/'))
        return path;
    if (path == "." || path == "./")
        return folder;
    const std::string rest = path.starts_with("./") ? path.substr(2) : path;
    return folder.ends_with('/') ? folder + rest : folder + "/" + rest;
}

std::string folder_of(const std::string& file)
{
    const std::size_t slash = file.rfind('/');
    if (slash == std::string::npos)
        return "";
    return slash == 0 ? "/" : file.substr(0, slash);
}

void take_from(const std::string& folder, const ConfigKey& key, Config& config)
{
    if (const auto* path = std::get_if<PathKey>(&key.kind)) {
        path->reach(config) = path_from(folder, path->reach(config));
    } else if (const auto* binding = std::get_if<BindingKey>(&key.kind)) {
        CameraBinding& bound = binding->reach(config);
        if (bound.by == BoundBy::kReplay)
            bound.what = path_from(folder, bound.what);
    }
}

Config all_taken_from(const std::string& folder, Config config)
{
    for (const ConfigKey& key : config_keys())
        take_from(folder, key, config);
    return config;
}

} // namespace dicot::app
