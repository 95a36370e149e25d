// What a pull came to, for people and for programs.
#pragma once

#include "pull_board.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace dicot::app {

/// A table, and under it what a person may want to know beside it.
std::string pull_table(const std::vector<PullReport>& reports);
nlohmann::json pull_json(const PullReport& report);

} // namespace dicot::app
