#include "cloud_on_disk.h"

#include "dicot/base/arena.h"
#include "dicot/os/input_file.h"
#include "dicot/os/shown_path.h"

namespace dicot::app {

Result<CloudOnDisk> CloudOnDisk::read(const char* path)
{
    InputFile file;
    TRY(file.open(path));
    if (file.size_bytes() > kMaxCloudFileBytes)
        return failure(Fault::kBadData,
                       "%s: larger than any cloud file (%zu MiB): give a file that 'dicot process' wrote",
                       shown_path(path), kMaxCloudFileBytes >> 20);
    const MemoryBlock packed = TRY(MemoryBlock::map(static_cast<std::size_t>(file.size_bytes())));
    return decode(packed.bytes().first(TRY(file.read(packed.bytes()))), path);
}

Result<CloudOnDisk> CloudOnDisk::decode(std::span<const std::byte> file, const char* name)
{
    CloudOnDisk read;
    read.outline_ = TRY(outline_of(file, name));
    const MemoryBlock heap = TRY(MemoryBlock::map(decode_heap_bytes(read.outline_.points)));
    Arena measure;
    (void)measure.take<CloudPoint>(read.outline_.points);
    read.points_ = TRY(MemoryBlock::map(measure.peak()));
    Arena arena{read.points_.bytes()};
    const auto points = arena.take<CloudPoint>(read.outline_.points);
    TRY(decode_cloud(file, read.outline_, name, heap.bytes(), points));
    read.cloud_ = {points, read.outline_.grid};
    read.file_bytes_ = file.size();
    return read;
}

} // namespace dicot::app
