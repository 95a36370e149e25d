// The folder that the pairs of a live calibration go to: a calibration reads them from there like any others.
#pragma once

#include "dicot/base/image.h"
#include "dicot/base/status.h"

#include <string>
#include <vector>

namespace dicot::app {

struct KeptPair
{
    std::string left; ///< paths
    std::string right;
};

class PairFolder
{
public:
    /// Makes the folder, or takes an empty one; with `resume` also one that holds pairs. Fault::kCannotCreate: it
    /// cannot be made or written into; something is in it, and `resume` is not set.
    static Result<PairFolder> open(const std::string& path, bool resume);

    /// The pairs of an earlier run, in the order of their names.
    const std::vector<KeptPair>& earlier() const { return earlier_; }

    /// Writes both pictures under the next number, left01.png and right01.png, durable: both, or none is there.
    /// Fault::kCannotCreate and kIoError as write_png().
    Status add(ImageView<const Rgb8> left, ImageView<const Rgb8> right);
    /// Of the last pair added.
    const std::string& last_name() const { return last_name_; }

    /// Removes a folder that this object made, if nothing is in it.
    void remove_if_empty() const;

    const std::string& path() const { return path_; }

private:
    std::string path_;
    bool made_ = false;
    std::vector<KeptPair> earlier_;
    int next_ = 1;
    std::string last_name_;
};

/// Where pairs go when nobody says: beside the rig file, `rig.yaml` -> `rig-pairs`.
std::string pairs_beside(const std::string& rig_path);

} // namespace dicot::app
