// What was measured on snapshots before, so that a season is not measured anew for one more day.
#pragma once

#include "snapshot_traits.h"

#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace dicot::app {

/// A file of lines, one a snapshot, under the digest that names all of its files. It may be deleted at any time, and is
/// begun anew by another version of the program. A line that was cut off by an interruption is passed over.
class TraitsCache
{
public:
    TraitsCache() = default; ///< remembers nothing

    /// `name`.traits in `folder`, which is made; `maker` names the program. Fault::kCannotCreate, kIoError.
    static Result<TraitsCache> open(const std::string& folder, const std::string& name, const std::string& maker);

    const SnapshotTraits* find(std::string_view sums) const;
    /// Kept when it returns, as far as the process is concerned. Fault::kIoError: the disk is full.
    Status add(std::string_view sums, const SnapshotTraits& traits);

private:
    struct Close
    {
        void operator()(std::FILE* file) const { (void)std::fclose(file); }
    };

    std::string path_;
    std::unique_ptr<std::FILE, Close> file_;
    std::map<std::string, SnapshotTraits, std::less<>> known_;
};

/// The cache's folder if none is named: dicot in XDG_CACHE_HOME, or in ~/.cache. Empty: there is no home.
std::string usual_cache_folder();

/// What a cache is opened with: the digest of this very program, so that no figure of an older one stands beside its
/// own. Fault::kNoInput, kIoError.
Result<std::string> cache_maker();
/// 64 hexadecimal digits. Errors: the same.
Result<std::string> digest_of_file(const std::string& path);

} // namespace dicot::app
