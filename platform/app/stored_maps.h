// The rectification tables of a rig as a file beside its rig file (storage/FORMAT.md).
#pragma once

#include "rectify_rig.h"

#include <optional>
#include <string>

namespace dicot::app {

/// RIG.yaml -> RIG.maps: a .yaml or .yml at the end gives way, anything else stays.
std::string maps_path(const std::string& rig_path);

/// What was stored.
struct StoredTables
{
    RectifyTables tables;
    MapChecksums checksums;
    std::size_t bytes = 0; ///< of the file
};

/// Builds the tables of `rig` and writes them to `path`, durable or absent. `rig_name` stands in the sentences.
/// Errors: those of RectifyTables::build() and of OutputFile.
Result<StoredTables> store_tables(const RigFile& rig, double keep, const std::string& rig_name,
                                  const std::string& path);

/// The tables in `path`, in memory of `arena`; nothing where there is no such file, where it is made for another
/// `keep`, and, with a sentence on stderr, where it cannot be read, is damaged or belongs to another rig.
std::optional<RigMaps> load_maps(const std::string& path, const StereoRig& rig, double keep, Arena arena,
                                 const char* rig_name);

} // namespace dicot::app
