// A record for a person: what matters of it, a line a thing. Any JSON at all gives no more than odd lines.
#pragma once

#include "dicot/catalogue/catalogue.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace dicot::app {

/// What the catalogue has.
std::string row_words(const SlotRow& row);
/// What record.json has beside it; empty of what is no object.
std::string record_words(const nlohmann::json& record);

} // namespace dicot::app
