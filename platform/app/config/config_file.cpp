// The configuration out of its file.
#include "config.h"
#include "config_keys.h"
#include "config_paths.h"

#include "dicot/os/input_file.h"

#include <unistd.h>

#include <cerrno>
#include <span>

namespace dicot::app {

Result<LoadedConfig> load_config(const std::string& path, const char* usual_path)
{
    const bool absent = ::access(usual_path, F_OK) != 0 && (errno == ENOENT || errno == ENOTDIR);
    if (path.empty() && absent) {
        LoadedConfig defaults;
        defaults.lines.assign(config_keys().size(), 0);
        return defaults;
    }
    const std::string name = path.empty() ? usual_path : path;
    InputFile file;
    TRY(file.open(name.c_str()));
    std::string text(kMostConfigBytes + 1, '\0'); // one more: parse_config() sees that it is too long
    text.resize(TRY(file.read(std::as_writable_bytes(std::span{text}))));
    return parse_config(text, name, folder_of(name));
}

} // namespace dicot::app
