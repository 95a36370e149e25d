// Writing a file that is there whole and durable, or not at all.
#pragma once

#include "dicot/base/byte_sink.h"
#include "dicot/base/status.h"

#include <climits>
#include <cstddef>
#include <span>

namespace dicot {

/// One output file. What is written goes to `<path>.<pid>.part` beside the target; commit() flushes, syncs, renames
/// over the target and syncs the directory; a file that is let go without commit() leaves nothing behind.
///
/// An existing target stays untouched until commit(), keeps its permissions, and a symbolic link is followed. Devices,
/// pipes and /dev/stdout are written directly: they cannot be renamed. One OutputFile a target at a time. No heap.
class OutputFile final : public ByteSink
{
public:
    static constexpr std::size_t kBufferBytes = std::size_t{16} * 1024;

    OutputFile() noexcept = default;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile() override;

    /// Opens the part file. Fault::kCannotCreate: no such folder, no permission, the target is a folder or a disk.
    Status open(const char* path) noexcept;
    /// Fault::kIoError: the disk is full, or the device failed. After a failure only the destructor remains to be
    /// called.
    Status write(std::span<const std::byte> bytes) noexcept override;
    Status write(const void* bytes, std::size_t count) noexcept;
    /// What was written so far is on the disk, and still out of sight: several files that belong together are all
    /// synced before the first is committed. Fault::kIoError as for write().
    Status sync() noexcept;
    /// Makes the file appear, durable. Fault::kIoError as for write().
    Status commit() noexcept;

    const char* path() const noexcept { return target_; }

private:
    Status open_part(bool replaces, unsigned mode) noexcept;
    Status open_direct(const char* path) noexcept;
    Status flush() noexcept;
    Status sync_directory() noexcept;
    Status io_failure(int error) const noexcept;
    void abandon() noexcept;

    int descriptor_ = -1;
    bool direct_ = false;
    std::size_t buffered_ = 0;
    char target_[PATH_MAX] = {};
    char part_[PATH_MAX] = {};
    std::byte buffer_[kBufferBytes];
};

} // namespace dicot
