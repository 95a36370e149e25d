// A folder that appears with everything in it, or not at all.
#pragma once

#include "dicot/base/status.h"

#include <string>

namespace dicot::app {

/// What is written goes to a hidden folder beside the target; commit() syncs and renames it. Let go without commit(),
/// it and its files are removed.
class PartFolder
{
public:
    PartFolder() = default;
    PartFolder(const PartFolder&) = delete;
    PartFolder& operator=(const PartFolder&) = delete;
    ~PartFolder();

    /// `around` is made if it is missing. Fault::kCannotCreate.
    Status open(const std::string& around, const std::string& name);
    const std::string& path() const noexcept { return part_; } ///< where to write
    /// Where it will stand, or stands. A name that is taken gets "_2", "_3" and so on when it is committed.
    const std::string& target() const noexcept { return target_; }
    /// Never replaces anything. Fault::kIoError.
    Status commit();

private:
    std::string part_;
    std::string target_;
};

} // namespace dicot::app
