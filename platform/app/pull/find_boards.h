// Where boards' folders stand on a device that is not ours.
#pragma once

#include "device_talk.h"

namespace dicot::app {

struct BoardFolder
{
    std::uint32_t storage = 0, handle = 0;
    std::string device; ///< its name; is_device_name()
    std::string path;   ///< from the top of the storage, names with '/' between them
};

inline constexpr std::size_t kMostDepth = 8;
inline constexpr std::size_t kMostWalked = 20'000; ///< folders that are looked at

/// Folders with days in them, and in those snapshots; the nearest to the top first. Fault::kBadData: there is none, and
/// the tree is larger than what is looked at.
Status find_boards(DeviceTalk& talk, std::vector<BoardFolder>& into);

/// The folder at a path of names as BoardFolder has it. Fault::kNoInput: not there any more.
Status find_folder(DeviceTalk& talk, std::uint32_t storage, std::string_view path, std::uint32_t& handle);

/// What a day's folder shows, as far as it is a snapshot of that day.
Status snapshots_of_day(DeviceTalk& talk, std::uint32_t storage, std::uint32_t day, std::string_view day_name,
                        FunctionRef<bool(const OfferedSnapshot&)> visit);

} // namespace dicot::app
