#include "stored_maps.h"

#include "dicot/os/input_file.h"
#include "dicot/os/output_file.h"
#include "dicot/os/shown_path.h"

#include <cstdio>
#include <unistd.h>
#include <utility>

namespace dicot::app {
namespace {

Result<RigMaps> read_file(const std::string& path, const StereoRig& rig, double keep, Arena& arena)
{
    const char* name = shown_path(path.c_str());
    InputFile file;
    TRY(file.open(path.c_str()));
    if (file.size_bytes() > most_map_bytes(rig.width, rig.height))
        return failure(Fault::kBadData, "%s: larger than the tables of any rig of this size", name);
    const MemoryBlock block = TRY(MemoryBlock::map(static_cast<std::size_t>(file.size_bytes())));
    const auto bytes = block.bytes().first(TRY(file.read(block.bytes())));
    return read_maps(bytes, rig, keep, arena, name);
}

} // namespace

std::string maps_path(const std::string& rig_path)
{
    std::string stem = rig_path;
    for (const char* ending : {".yaml", ".yml"})
        if (stem.ends_with(ending)) {
            stem.resize(stem.size() - std::string(ending).size());
            break;
        }
    return stem + ".maps";
}

Result<StoredTables> store_tables(const RigFile& rig, double keep, const std::string& rig_name, const std::string& path)
{
    RigFile flat = rig;
    StoredTables stored{TRY(RectifyTables::build(flat, keep, rig_name.c_str())), {}, 0};
    const RigMaps& maps = stored.tables.maps();
    stored.bytes = map_bytes(maps);
    const MemoryBlock block = TRY(MemoryBlock::map(stored.bytes));
    stored.checksums = write_maps(maps, TRY(stereo_rig_of(rig, rig_name.c_str())), keep, block.bytes());
    OutputFile file;
    TRY(file.open(path.c_str()));
    TRY(file.write(block.bytes()));
    TRY(file.commit());
    return stored;
}

std::optional<RigMaps> load_maps(const std::string& path, const StereoRig& rig, double keep, Arena arena,
                                 const char* rig_name)
{
    if (::access(path.c_str(), F_OK) != 0)
        return std::nullopt;
    const Result<RigMaps> read = read_file(path, rig, keep, arena);
    if (read.ok())
        return read.value();
    if (read.status().fault() != Fault::kConfig)
        std::fprintf(stderr,
                     "dicot: warning: %s; the tables are built in memory: 'dicot rig tables %s' stores them anew\n",
                     read.status().message(), rig_name);
    return std::nullopt;
}

} // namespace dicot::app
