// How one board is, out of its store alone.
#pragma once

#include "health_record.h"

#include "../store/store_summary.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace dicot::app {

/// Medians of one day's snapshots, UTC.
struct HealthDay
{
    std::string day; ///< 2026-06-01
    int done = 0, missed = 0;
    std::optional<double> luma;        ///< of both pictures
    std::optional<double> focus;       ///< of the picture that is less sharp
    std::optional<double> epipolar_px; ///< median residual
    std::optional<double> fill;        ///< 0 .. 1
};

/// Misses for one reason, figures in it aside.
struct HealthMiss
{
    std::string reason; ///< of the newest one
    int count = 0;
    std::int64_t newest = 0; ///< number of the slot
};

struct BoardHealth
{
    StoreSummary summary;
    std::optional<SlotRow> newest_slot;
    std::optional<HealthFigures> newest; ///< of the newest snapshot that is done and readable
    HealthFlags flags;                   ///< of that one, and of what was missed since
    int slots = 0, missed = 0;           ///< of the last kMissDays days before the newest slot
    std::vector<HealthMiss> misses;      ///< these, most frequent first
    std::vector<HealthDay> trend;        ///< of the newest kTrendDays days that have slots
    int unread = 0;                      ///< records that cannot be read

    static constexpr int kMissDays = 7;
    static constexpr int kTrendDays = 14;
    /// No more slots than this, the newest ones, are looked at.
    static constexpr std::int64_t kMostSlots = 4096;

    /// None: nothing is flagged.
    std::optional<Severity> worst() const;
};

/// Errors: the catalogue's, those of store_summary().
Result<BoardHealth> board_health(ReadStore& store, const StoreRules& rules, const std::string& path);

/// Everything as JSON: newest slot, figures, flags, misses, trend, store.
nlohmann::json board_json(const BoardHealth& board);

/// For a terminal of 100 columns. `device` and `path` are shown escaped.
std::string board_words(const BoardHealth& board, const std::string& device, const std::string& path);

} // namespace dicot::app
