// Lines beside a file system, on the same disk: in the disk's log they stand between its writes.
#pragma once

#include "dicot/base/status.h"

#include <cstdint>
#include <memory>

namespace dicot {

/// Each line goes around the cache to a sector of its own, behind the file system's end. It is handed to the disk
/// before put() returns; nothing is flushed for it.
class Marks
{
public:
    static constexpr int kSectorBytes = 512;

    /// `device`: the disk; the first mark goes to byte `first`, which must be on a sector. Fault::kUnavailable.
    static Result<Marks> open(const char* device, std::int64_t first);
    Marks(Marks&& other) noexcept;
    Marks& operator=(Marks&&) = delete;
    ~Marks();

    /// A printf-formatted line of less than a sector.
    Status put(const char* format, ...) __attribute__((format(printf, 2, 3)));

private:
    Marks(int descriptor, std::int64_t first) : descriptor_(descriptor), next_(first) {}

    int descriptor_;
    std::int64_t next_;
};

} // namespace dicot
