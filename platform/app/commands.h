// One line a command: each adds its words to the command line and, when chosen, sets what main will run.
#pragma once

#include "command.h"

namespace dicot::app {

void add_accuracy(CLI::App& program, Command& chosen);
void add_aim(CLI::App& program, Command& chosen);
void add_archive(CLI::App& program, Command& chosen);
void add_bench(CLI::App& program, Command& chosen);
void add_calibrate(CLI::App& program, Command& chosen);
void add_capture(CLI::App& program, Command& chosen);
void add_config(CLI::App& program, Command& chosen);
void add_diag(CLI::App& program, Command& chosen);
void add_evaluate(CLI::App& program, Command& chosen);
void add_gadget(CLI::App& program, Command& chosen);
void add_health(CLI::App& program, Command& chosen);
void add_list(CLI::App& program, Command& chosen);
void add_match(CLI::App& program, Command& chosen);
void add_plant(CLI::App& program, Command& chosen);
void add_probe(CLI::App& program, Command& chosen);
void add_process(CLI::App& program, Command& chosen);
void add_prune(CLI::App& program, Command& chosen);
void add_rectify(CLI::App& program, Command& chosen);
void add_pull(CLI::App& program, Command& chosen);
void add_rig(CLI::App& program, Command& chosen);
void add_export(CLI::App& program, Command& chosen);
void add_info(CLI::App& program, Command& chosen);
void add_memory(CLI::App& program, Command& chosen);
void add_run(CLI::App& program, Command& chosen);
void add_schedule(CLI::App& program, Command& chosen);
void add_selftest(CLI::App& program, Command& chosen);
void add_show(CLI::App& program, Command& chosen);
void add_snap(CLI::App& program, Command& chosen);
void add_traits(CLI::App& program, Command& chosen);
void add_verify(CLI::App& program, Command& chosen);
void add_view(CLI::App& program, Command& chosen);

} // namespace dicot::app
