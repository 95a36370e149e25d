// What a matcher owns.
#pragma once

#include "column_paths.h"
#include "cost_rows.h"
#include "fast_rows.h"
#include "highlights.h"
#include "lab.h"
#include "refine.h"
#include "scanline.h"
#include "select.h"
#include "surfaces.h"
#include "tables.h"

#include <span>

namespace dicot::matching {

/// One worker's tables.
struct Station
{
    CostRows costs;
    FastRows fast;
    ScanlinePass scanline;
    Selector selector;
    MatchTimes times;
};

/// Everything that a matcher owns, in its arena.
struct Bench
{
    Scene scene;
    LabTables lab;
    Maps maps;
    ColourWeights voters;            ///< how much neighbours count when kBest fills: colours may differ more
    std::span<std::uint8_t> columns; ///< scratch of kBest, one entry a column
    RawCosts raw;                    ///< of kBest
    ColumnPaths paths;               ///< of kBest
    SurfaceRefiner refiner;          ///< of kBest
    Highlights highlights;           ///< of kBest
    std::span<Station> stations;
};

} // namespace dicot::matching
