// Health as record.json has it: what is measured for it alone, and the flags. All else stands in the record already.
#pragma once

#include "health_figures.h"
#include "health_history.h"
#include "judge_health.h"

#include "dicot/aiming/focus.h"
#include "dicot/catalogue/catalogue.h"
#include "dicot/drift/drift.h"
#include "dicot/medium/medium.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace dicot::app {

/// The figures of a record, from wherever they stand in it. Any JSON at all: what is missing, of another type or out of
/// its range is not known.
HealthFigures figures_from_record(const nlohmann::json& record);
/// The first residuals of its calibration, as the record hands them on; how many.
std::size_t reference_from_record(const nlohmann::json& record, std::span<double> medians_px);

/// What is not in the record before it has its "health".
void add_focus(HealthFigures& figures, const aiming::Focus& left, const aiming::Focus& right) noexcept;
void add_drift(HealthFigures& figures, const EpipolarDrift& drift) noexcept;

/// How the card is: `reserve_bytes` is left to others. What it does not tell is not known.
HealthCard card_health(Medium& medium, Catalogue& catalogue, std::uint64_t reserve_bytes);

/// The object behind "health". `history` already knows `figures`: the reference goes on from record to record.
nlohmann::json health_record(const HealthFigures& figures, const HealthHistory& history, const HealthFlags& flags);

/// A slot's end: judges it, adds it to the history, and puts "health" into its record.
HealthFlags judge_and_record(nlohmann::json& record, const HealthFigures& figures, HealthHistory& history);

/// All figures and nothing else, for programs; what is not known is null.
nlohmann::json figures_json(const HealthFigures& figures);
nlohmann::json flags_json(const HealthFlags& flags);

/// What the newest records of a store say, at most `slots` of them (misses too); a record that cannot be read is passed
/// over. Uses the heap: before it is sealed.
/// One of them; none: it is not in its place, or no record. What it hands on goes to the history, which has not seen
/// it yet.
std::optional<HealthFigures> read_figures(Medium& medium, const SlotRow& row, HealthHistory& history);
HealthHistory read_history(Medium& medium, Catalogue& catalogue, std::int64_t slots = 256);

} // namespace dicot::app
