// What one slot says of the rig's health. No heap: a series keeps many of them.
#pragma once

#include "dicot/base/short_text.h"

#include <cstdint>
#include <optional>

namespace dicot::app {

/// Of one camera's picture, as the camera gave it.
struct HealthSide
{
    std::optional<double> luma;      ///< mean, 0 .. 255
    std::optional<double> saturated; ///< share of pixels, 0 .. 1
    std::optional<double> focus;     ///< 0 .. 100 (dicot/aiming/focus.h)
};

/// The residual of the rows (dicot/drift/drift.h).
struct HealthEpipolar
{
    double median_px = 0;
    double spread_px = 0;
    double roll_deg = 0;   ///< of the right camera against the left one, clockwise, seen from behind
    double height_ppm = 0; ///< by how much the right camera sees things larger
    double corner_px = 0;  ///< the largest residual that median and slopes make in a corner
    int points = 0;
};

/// What opening the store had to mend.
struct HealthRepairs
{
    int finished = 0, interrupted = 0, left_over = 0, rows_added = 0;
    bool catalogue_new = false;

    friend bool operator==(const HealthRepairs&, const HealthRepairs&) = default;
};

/// The card as the snapshot found it.
struct HealthCard
{
    std::optional<double> days_left; ///< none: not known yet how fast it fills
    std::optional<double> room_mib;  ///< free beyond the reserve
    std::optional<std::int64_t> in_quarantine;
};

/// Everything that is not known has no value: an old record, a miss, a machine without sensors.
struct HealthFigures
{
    std::int64_t sequence = 0;
    std::int64_t began_us = 0; ///< since 1970, UTC, by the board's clock
    bool done = false;
    ShortText<63> calibration_id; ///< of the rig file; residuals of different ones are not compared
    HealthSide left, right;
    std::optional<HealthEpipolar> epipolar;
    std::optional<double> skew_ms;       ///< right minus left
    std::optional<double> most_skew_ms;  ///< what the configuration allowed
    std::optional<double> fill;          ///< share of the left picture's pixels that became points, 0 .. 1
    std::optional<double> hottest_c;     ///< degrees Celsius, of all sensors
    ShortText<31> clock_trust;           ///< empty: not known
    std::optional<double> clock_error_s; ///< the kernel's bound
    HealthCard card;
    HealthRepairs repairs;
    int shakes = 0;       ///< restarts, reopenings and port resets of both cameras
    bool gave_up = false; ///< a camera did not come back
};

} // namespace dicot::app
