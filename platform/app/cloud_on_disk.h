// A cloud file, read and decoded.
#pragma once

#include "dicot/base/cloud.h"
#include "dicot/codec/decode_cloud.h"
#include "dicot/os/memory_block.h"

#include <cstddef>
#include <span>

namespace dicot::app {

/// A decoded cloud together with the memory that it lies in.
class CloudOnDisk
{
public:
    /// Errors: kNoInput when it is missing, kBadData when it is no cloud or damaged, kOsError without memory.
    static Result<CloudOnDisk> read(const char* path);
    /// The same of a file's bytes, which need not outlive the call; `name` is the file's, for sentences.
    static Result<CloudOnDisk> decode(std::span<const std::byte> file, const char* name);

    const PointCloud& cloud() const { return cloud_; }
    const CloudMeta& meta() const { return outline_.meta; }
    std::size_t file_bytes() const { return file_bytes_; }

private:
    MemoryBlock points_;
    CloudOutline outline_;
    PointCloud cloud_;
    std::size_t file_bytes_ = 0;
};

} // namespace dicot::app
