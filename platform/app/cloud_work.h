// A pair's way to a compressed cloud, in memory that was measured and mapped before.
#pragma once

#include "cloud_plan.h"
#include "file_shelf.h"
#include "process_bench.h"

#include "dicot/base/image.h"
#include "dicot/codec/encode_cloud.h"
#include "dicot/drift/drift.h"
#include "dicot/os/clock.h"
#include "dicot/os/thread_crew.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace dicot::app {

/// Where a pair comes from.
class PairSource
{
public:
    /// Fills both pictures of the rig's size. `scratch` is what measure() asked for, and gone afterwards.
    virtual Status fill(ImageView<Rgb8> left, ImageView<Rgb8> right, Arena scratch) = 0;

protected:
    ~PairSource() = default;
};

struct StageTimes
{
    double read_s = 0, rectify_s = 0, match_s = 0, drift_s = 0, triangulate_s = 0, encode_s = 0, write_s = 0,
           pictures_s = 0;
};

/// Seconds since it was asked last.
class StopWatch
{
public:
    double lap_s()
    {
        const std::int64_t now = monotonic_us();
        const double lap = static_cast<double>(now - last_us_) * 1e-6;
        last_us_ = now;
        return lap;
    }

private:
    std::int64_t last_us_ = monotonic_us();
};

/// What is put on the shelf beside the cloud; empty names are left out.
struct PictureNames
{
    std::string left;      ///< as it was matched, .jpg
    std::string disparity; ///< in colour, .png
    std::string preview;   ///< the cloud from two viewpoints, .png
};

/// One pair at a time; the results of a stage stay until the next pair.
class CloudWork
{
public:
    /// Takes all memory and starts the threads. `scratch_bytes`: what PairSource::fill() needs. `plan` is borrowed.
    static Result<std::unique_ptr<CloudWork>> make(const CloudPlan& plan, std::size_t scratch_bytes);

    /// From the source to points, matched with a bar of progress where `shows_progress`. Errors: the source's and the
    /// shelf's.
    Status see(PairSource& source, const PictureNames& names, FileShelf& shelf, bool shows_progress);
    /// Compresses what was seen, `meta` with it, and proves it. Errors: those of encode_cloud().
    Status encode(const CloudMeta& meta);
    Status write_cloud(const char* name, FileShelf& shelf);
    Status write_ply(const std::string& path);
    Status write_preview(const PictureNames& names, FileShelf& shelf);

    const PointCloud& cloud() const noexcept { return cloud_; }
    const PixelCount& pixels() const noexcept { return pixels_; }
    /// How far the rows of the pair were apart; not known of one that was not matched.
    const EpipolarDrift& drift() const noexcept { return drift_; }
    const EncodedCloud& encoded() const noexcept { return encoded_; }
    const ProcessBudget& budget() const noexcept { return bench_.budget(); }
    const CloudPlan& plan() const noexcept { return plan_; }
    StageTimes times;
    std::int64_t stage_bound_us = 0; ///< of each, for the StageWatch; 0: none

private:
    CloudWork(const CloudPlan& plan, ProcessBench bench);

    const CloudPlan& plan_;
    ProcessBench bench_;
    ThreadCrew crew_;
    PointCloud cloud_;
    PixelCount pixels_;
    EpipolarDrift drift_;
    EncodedCloud encoded_;
};

} // namespace dicot::app
