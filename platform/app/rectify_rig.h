// From a rig file to rectification tables, and what the rectified rig is.
#pragma once

#include "dicot/os/memory_block.h"
#include "dicot/rectification/rectify.h"
#include "dicot/rectification/remap_table.h"
#include "dicot/rig/rig_file.h"

namespace dicot::app {

/// Whether the file describes unrectified cameras: K1, K2, R and T are there.
bool describes_cameras(const RigFile& rig);

/// The cameras of a rig file. Fault::kBadData: K1, K2, R or T is missing, skew, a tilted sensor.
Result<StereoRig> stereo_rig_of(const RigFile& rig, const char* name);

/// Fills R1 R2 P1 P2 Q.
void set_rectification(RigFile& rig, const Rectification& flat);

/// The tables of both cameras, in memory of their own, made before the heap is sealed.
class RectifyTables
{
public:
    /// Rectifies `rig` (filling R1 R2 P1 P2 Q) and builds both tables. `keep` as in rectify().
    /// Errors: those of stereo_rig_of(), rectify() and RemapTable::build(); kOsError without memory.
    static Result<RectifyTables> make(RigFile& rig, double keep, const char* name);

    const RemapTable& left() const { return left_; }
    const RemapTable& right() const { return right_; }
    std::span<RemapSpan> spans() const { return spans_; } ///< scratch for remap()
    std::size_t reserved_bytes() const { return block_.bytes().size(); }

private:
    explicit RectifyTables(MemoryBlock block) : block_(std::move(block)) {}

    MemoryBlock block_;
    RemapTable left_, right_;
    std::span<RemapSpan> spans_;
};

} // namespace dicot::app
