// What there is to pull from: devices on cables, or the boards in a folder.
#pragma once

#include "dicot/pull_archive/pull_source.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace dicot::app {

/// Opened by the thread that pulls from it; all its boards belong to that thread.
struct PullJob
{
    std::string where; ///< for people
    std::function<Result<std::vector<std::unique_ptr<PullSource>>>()> open;
    bool must_open = true; ///< that it cannot be opened is a failure even if others can
};

/// The boards in `folder`: of one board, around the folders of several, or the root of a board's card. `device`: this
/// board's alone, if it is not empty. Fault::kNoInput: no such folder, or no board's in it; kBadData: nobody can say
/// what the board is called.
Result<std::vector<PullJob>> jobs_of_folder(const std::string& folder, const std::string& device);

/// The devices that are plugged in. `serial`: that one's alone, if it is not empty. Fault::kUnavailable: there is none.
Result<std::vector<PullJob>> jobs_of_devices(const std::string& serial);

} // namespace dicot::app
