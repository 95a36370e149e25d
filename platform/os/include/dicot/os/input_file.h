// Reading a file from front to back.
#pragma once

#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// A regular file that is open for reading. No heap, no buffer of its own.
class InputFile
{
public:
    InputFile() noexcept = default;
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    ~InputFile();

    /// Fault::kNoInput: missing, not readable, or no regular file (a folder, a pipe, a device).
    /// `path` is borrowed for as long as the file is used.
    Status open(const char* path) noexcept;
    /// Fills `into` from where the last read ended; fewer bytes only at the end of the file. Fault::kIoError.
    Result<std::size_t> read(std::span<std::byte> into) noexcept;

    std::uint64_t size_bytes() const noexcept { return size_bytes_; } ///< as it was when the file was opened
    const char* path() const noexcept { return path_; }

private:
    int descriptor_ = -1;
    std::uint64_t size_bytes_ = 0;
    const char* path_ = "";
};

} // namespace dicot
