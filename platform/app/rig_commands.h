// What 'dicot rig' can do: one line each, one file each.
#pragma once

#include "command.h"

namespace dicot::app {

void add_rig_show(CLI::App& rig, Command& chosen);
void add_rig_convert(CLI::App& rig, Command& chosen);
void add_rig_tables(CLI::App& rig, Command& chosen);

} // namespace dicot::app
