// What follows from a rig file, a working range and the words of matching, before anything large begins.
#pragma once

#include "match_words.h"
#include "rectify_rig.h"

#include "dicot/cloud/triangulate.h"
#include "dicot/cloud/working_range.h"
#include "dicot/codec/encode_cloud.h"
#include "dicot/kernels/kernels.h"

#include <optional>
#include <string>

namespace dicot::app {

struct CloudWords
{
    std::string rig;                       ///< its file
    std::optional<double> near_mm, far_mm; ///< none: the rig file's
    MatchWords match;
};

struct CloudPlan
{
    RigGeometry rig;
    std::optional<RectifyTables> tables; ///< when the pictures come from the cameras as they are
    WorkingRange range;
    Triangulation triangulation;
    MatchOptions match;
    const Kernels* kernels = nullptr;
    int threads = 1;
    CloudMeta meta;
};

/// For pictures of `width` x `height` px, `pictures` naming them in sentences. Errors: those of read_rig_file() and
/// RectifyTables::load_or_build(); Fault::kBadData: the rig file is of another size; kUsage: no working range;
/// kUnavailable: choose_kernels().
Result<CloudPlan> make_cloud_plan(const CloudWords& words, int width, int height, const char* pictures);

} // namespace dicot::app
