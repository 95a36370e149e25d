// Which pictures of a folder belong together: one name says left, the other right, and the rest is the same.
#pragma once

#include "dicot/base/status.h"

#include <span>
#include <string>
#include <vector>

namespace dicot::app {

struct PicturePair
{
    std::string left; ///< names as they were given
    std::string right;

    friend bool operator==(const PicturePair&, const PicturePair&) = default;
};

struct LonePicture
{
    std::string name;
    std::string reason; ///< for a person

    friend bool operator==(const LonePicture&, const LonePicture&) = default;
};

struct PairedNames
{
    std::vector<PicturePair> pairs; ///< in the order of their names, 2 before 10
    std::vector<LonePicture> alone; ///< in the same order
    int lefts = 0;                  ///< pictures that say left, paired or not
    int rights = 0;
};

/// Pairs names of files, each with at most one folder in front of it. A name's side is its word `left` or `right`, else
/// `cam0` or `cam1` (`cam1` or `cam2` where nothing is called `cam0`), else `l` or `r`: a word of its own between
/// digits, signs, slashes and changes of case, in any case. The rest must be equal, but for case, leading zeros and the
/// ending. One pair each: where names differ in zeros or endings alone, equal spellings are paired, PNG first.
PairedNames pair_names(std::span<const std::string> names);

/// The pictures of a folder (PNG, JPEG, PPM and PGM by their endings), their names relative to it. Where the folder
/// itself holds no pair, its folders for the two sides (`left/` and `right/`, `cam0/` and `cam1/`, `l/` and `r/`) are
/// looked into; no others are. Fault::kNoInput, with the reason: no folder, no pictures, no pair among them.
Result<PairedNames> pairs_in_folder(const std::string& folder);

} // namespace dicot::app
