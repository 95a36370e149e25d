// From a rig file to rectification tables, and what the rectified rig is.
#pragma once

#include "dicot/os/memory_block.h"
#include "dicot/rectification/rectify.h"
#include "dicot/rectification/remap_table.h"
#include "dicot/rectification/rig_maps.h"
#include "dicot/rig/rig_file.h"

#include <string>

namespace dicot::app {

/// Whether the file describes unrectified cameras: K1, K2, R and T are there.
bool describes_cameras(const RigFile& rig);

/// The cameras of a rig file. Fault::kBadData: K1, K2, R or T is missing, skew, a tilted sensor.
Result<StereoRig> stereo_rig_of(const RigFile& rig, const char* name);

/// Fills R1 R2 P1 P2 Q.
void set_rectification(RigFile& rig, const Rectification& flat);

/// One line on stdout: size, exactness, coverage.
void print_table(const char* side, const RemapTable& table);

/// The tables of both cameras, in memory of their own, made before the heap is sealed.
class RectifyTables
{
public:
    /// Rectifies `rig` (filling R1 R2 P1 P2 Q) and builds both tables. `keep` as in rectify(); `name` is the rig
    /// file's. Errors: those of stereo_rig_of(), rectify() and RemapTable::build(); kOsError without memory.
    static Result<RectifyTables> build(RigFile& rig, double keep, const char* name);
    /// The same tables, out of the file beside the rig file (stored_maps.h) where it is whole and made for this rig and
    /// `keep`; else as build(). A file that is damaged or of another rig is named on stderr, and left as it is.
    static Result<RectifyTables> load_or_build(RigFile& rig, double keep, const char* rig_path);

    const RemapTable& left() const { return maps_.left; }
    const RemapTable& right() const { return maps_.right; }
    const RigMaps& maps() const { return maps_; }
    std::span<RemapSpan> spans() const { return spans_; }           ///< scratch for remap()
    const std::string& loaded_from() const { return loaded_from_; } ///< empty: they were built
    double milliseconds() const { return milliseconds_; }           ///< that building or loading took
    /// For people: "built in 61.2 ms", "loaded from rig.maps in 2.1 ms".
    std::string origin() const;

    /// What the tables of a rig with pictures of this size take, found before they are made.
    static std::size_t reserved_bytes(int width, int height);

private:
    explicit RectifyTables(MemoryBlock block) : block_(std::move(block)) {}
    static Result<RectifyTables> make(RigFile& rig, double keep, const char* rig_path, bool may_load);

    MemoryBlock block_;
    RigMaps maps_;
    std::span<RemapSpan> spans_;
    std::string loaded_from_;
    double milliseconds_ = 0;
};

} // namespace dicot::app
