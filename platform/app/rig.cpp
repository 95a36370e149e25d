// dicot rig: what is known of a rig, shown and exchanged.
#include "commands.h"
#include "rig_commands.h"

namespace dicot::app {

void add_rig(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("rig", "What a rig file says, and the same for other programs");
    command->require_subcommand(1);
    add_rig_show(*command, chosen);
    add_rig_convert(*command, chosen);
    add_rig_tables(*command, chosen);
}

} // namespace dicot::app
