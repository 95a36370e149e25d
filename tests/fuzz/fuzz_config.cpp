// Any text as a configuration: refused with one printable sentence, or taken, printed and taken again.
#include "config/config.h"
#include "config/config_keys.h"
#include "config/config_paths.h"
#include "config/config_text.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace {

void require(bool promise)
{
    if (!promise)
        std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot;
    using namespace dicot::app;
    const std::string_view text{static_cast<const char*>(static_cast<const void*>(data)), size};
    const Result<LoadedConfig> first = parse_config(text, "fuzz", "folder");
    if (!first.ok()) {
        require(first.status().fault() == Fault::kConfig);
        require(std::strncmp(first.status().message(), "fuzz:", 5) == 0);
        for (const char* c = first.status().message(); *c != '\0'; ++c)
            require(*c >= ' ' && *c <= '~');
        return 0;
    }
    require(first.value().lines.size() == config_keys().size());
    const Config wanted = all_taken_from("/here", first.value().config);
    const Result<LoadedConfig> second = parse_config(config_toml(first.value(), "/here"), "printed", "/elsewhere");
    if (!second.ok()) // paths have grown by "/here/"
        require(size > 4000);
    else
        for (const ConfigKey& key : config_keys())
            require(toml_of(key, second.value().config) == toml_of(key, wanted));
    return 0;
}
