// One line of /proc, /sys or /run at a time.
#pragma once

#include "dicot/base/short_text.h"

#include <optional>

namespace dicot {

/// The first line of a file, without its end; what is longer is cut. None: not there, or it does not answer. No heap.
std::optional<ShortText<255>> read_line(const char* path) noexcept;

/// Writes `text` in one go into a file that is there. 0, or the errno.
int write_line(const char* path, const char* text) noexcept;

/// A path of parts, for one call; what does not fit makes a path that is not there.
class JoinedPath
{
public:
    explicit JoinedPath(const char* format, ...) noexcept __attribute__((format(printf, 2, 3)));
    const char* c_str() const noexcept { return bytes_; }

private:
    char bytes_[512];
};

} // namespace dicot
