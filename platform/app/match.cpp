#include "commands.h"

namespace dicot::app {

void add_match(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("match", "Disparity map of a rectified stereo pair");
    command->callback([&chosen] { chosen = [] { return failure(Fault::kSoftware, "match is being built"); }; });
}

} // namespace dicot::app
