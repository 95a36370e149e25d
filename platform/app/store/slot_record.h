// What record.json says of a slot beside its cameras, its pair and its cloud.
#pragma once

#include "../config/config.h"
#include "../run/slot_notes.h"

#include "dicot/os/clock_trust.h"
#include "dicot/store/store.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>

namespace dicot::app {

/// Of a slot that was planned.
nlohmann::json plan_record(const SlotNotes& notes);
nlohmann::json clock_record(const ClockReading& clock);
/// Degrees Celsius by the sensor's name.
nlohmann::json temperatures_record();
/// Every key of the configuration with the value that held.
nlohmann::json parameters_record(const Config& config);
nlohmann::json start_record(const StartReport& report);
/// `arena_bytes`: what was carved out before the snapshot.
nlohmann::json memory_record(std::size_t arena_bytes);
/// "digests" and "bytes_written" of the files that were added so far.
void files_into(nlohmann::json& record, const Store& store);

} // namespace dicot::app
