#include "config_words.h"

namespace dicot::app {

void ConfigWords::add_to(CLI::App& command)
{
    command.add_option("--config", file, "configuration (default: /etc/dicot/dicot.toml, if it is there)")
        ->type_name("FILE");
}

} // namespace dicot::app
