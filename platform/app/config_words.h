// The word by which a command is told where its configuration stands.
#pragma once

#include "command.h"
#include "config/config.h"

#include <string>

namespace dicot::app {

struct ConfigWords
{
    std::string file; ///< empty: the usual one, if it is there

    void add_to(CLI::App& command);
    /// Errors: those of load_config().
    Result<LoadedConfig> load() const { return load_config(file); }
};

} // namespace dicot::app
