// The bytes of a picture file, front to back, from a file or from memory.
#pragma once

#include "dicot/base/status.h"
#include "dicot/os/input_file.h"

#include <cstddef>
#include <span>

namespace dicot {

class ByteSource
{
public:
    static constexpr std::size_t kBufferBytes = std::size_t{16} * 1024;

    /// Both are borrowed.
    explicit ByteSource(InputFile& file) noexcept : name_(file.path()), file_(&file) {}
    ByteSource(std::span<const std::byte> bytes, const char* name) noexcept : name_(name), ahead_(bytes) {}
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;

    const char* name() const noexcept { return name_; }

    /// The bytes that come next, at least one of them, and all kBufferBytes of the front at first; empty at the end.
    std::span<const std::byte> ahead() noexcept
    {
        if (ahead_.empty())
            refill();
        return ahead_;
    }
    /// Passes over the first `count` bytes of ahead().
    void pass(std::size_t count) noexcept { ahead_ = ahead_.subspan(count); }
    /// The next byte, 0 .. 255, or -1 at the end.
    int next() noexcept
    {
        if (ahead().empty())
            return -1;
        const int value = std::to_integer<int>(ahead_.front());
        ahead_ = ahead_.subspan(1);
        return value;
    }
    /// Fills all of `into`, or tells that the end came first.
    bool read(std::span<std::byte> into) noexcept;

    /// Why the end came early, if reading failed.
    const Status& trouble() const noexcept { return trouble_; }

private:
    void refill() noexcept;

    const char* name_;
    InputFile* file_ = nullptr;
    std::span<const std::byte> ahead_{};
    Status trouble_;
    std::byte buffer_[kBufferBytes];
};

} // namespace dicot
