// What goes into the archive of dicot diag. No pictures; nothing of it is secret: the configuration has no such key.
#pragma once

#include "../store/store_words.h"

#include "dicot/archive/tar_gz.h"

#include <cstdint>
#include <string>

namespace dicot::app {

/// Members of one archive, below one folder. What cannot be had has a member of its name with ".missing.txt" behind
/// it, which says why. Only what keeps the archive itself from being written is an error.
class DiagMembers
{
public:
    DiagMembers(TarGz& archive, std::string folder) : archive_(archive), folder_(std::move(folder)) {}

    Status put(const std::string& name, std::string_view text);
    Status missing(const std::string& name, std::string_view why);
    /// As it stands there, kMostFile at most; also of /proc, whose files have no size.
    Status put_file(const std::string& name, const std::string& path);

    static constexpr std::size_t kMostFile = std::size_t{1} << 20;
    int made() const { return made_; }
    int not_made() const { return not_made_; }

private:
    TarGz& archive_;
    std::string folder_;
    int made_ = 0, not_made_ = 0;
};

/// Of the computer: processor, memory, mounts, USB, temperatures, clock, limits.
Status add_system(DiagMembers& members);

/// Of one board's store: the newest records, and what lies in its folders. Nothing is hashed.
Status add_board(DiagMembers& members, const DeviceFolder& device, std::int64_t records);

} // namespace dicot::app
