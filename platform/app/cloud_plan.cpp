#include "cloud_plan.h"

#include "rig_source.h"

#include "dicot/rig/rig_file.h"

namespace dicot::app {
namespace {

Result<WorkingRange> range_of(const CloudWords& words, const RigFile& rig)
{
    const std::optional<double> near_mm = words.near_mm ? words.near_mm : rig.near_mm;
    const std::optional<double> far_mm = words.far_mm ? words.far_mm : rig.far_mm;
    if (!near_mm || !far_mm)
        return failure(Fault::kUsage,
                       "%s names no working range: add near_mm and far_mm to it, or give them for this run (--near-mm "
                       "and --far-mm; "
                       "rig.near_mm and rig.far_mm in the configuration)",
                       words.rig.c_str());
    return WorkingRange{*near_mm, *far_mm};
}

} // namespace

Result<CloudPlan> make_cloud_plan(const CloudWords& words, int width, int height, const char* pictures)
{
    CloudPlan plan;
    plan.kernels = TRY(choose_kernels(words.match.cpu));
    plan.threads = words.match.resolved_threads();
    RigFile rig = TRY(read_rig_for_use(words.rig));
    if (width != rig.width || height != rig.height)
        return failure(Fault::kBadData,
                       "%s is %d x %d px, and %s is for %d x %d: use the rig file of these cameras and this size",
                       pictures, width, height, words.rig.c_str(), rig.width, rig.height);
    if (describes_cameras(rig))
        plan.tables = TRY(RectifyTables::load_or_build(rig, kCrop, words.rig.c_str()));
    plan.rig = TRY(geometry_of(rig, words.rig.c_str()));
    plan.range = TRY(range_of(words, rig));
    const DisparityRange search = TRY(disparity_range(plan.rig, plan.range));
    const CloudGrid grid = TRY(grid_for(plan.rig, plan.range));
    plan.triangulation = TRY(triangulation_for(plan.rig, plan.range, grid));
    plan.match = words.match.resolved();
    plan.match.min_disparity = search.min_disparity;
    plan.match.disparities = search.disparities;
    plan.meta.software = "dicot " DICOT_VERSION;
    plan.meta.calibration_id = rig.id;
    plan.meta.near_mm = plan.range.near_mm;
    plan.meta.far_mm = plan.range.far_mm;
    return plan;
}

} // namespace dicot::app
