#include "archive_folder.h"

#include "../config/device_name.h"
#include "../store/shown.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace dicot::app {

namespace fs = std::filesystem;

Result<std::string> archive_folder(const std::string& given)
{
    if (!given.empty())
        return std::string{given};
    const char* const home = std::getenv("HOME");
    if (home == nullptr || home[0] != '/')
        return failure(Fault::kUsage, "there is no home folder: name the archive's folder");
    return std::string{home} + "/dicot-clouds";
}

Result<std::vector<DeviceFolder>> boards_of_archive(const std::string& archive)
{
    std::vector<DeviceFolder> boards;
    std::error_code error;
    if (!fs::is_directory(archive, error))
        return failure(Fault::kNoInput, "%s: there is no archive: dicot pull makes it", shown(archive).c_str());
    if (TRY(is_device_folder(archive))) {
        boards.push_back({fs::path(archive + "/").parent_path().filename().string(), archive});
        return boards;
    }
    for (fs::directory_iterator entry(archive, error); !error && entry != fs::directory_iterator{};
         entry.increment(error)) {
        std::error_code unknown;
        const std::string name = entry->path().filename().string();
        // A board of which nothing has come yet has no day.
        if (!is_device_name(name) || !fs::is_directory(entry->status(unknown)))
            continue;
        const Result<bool> is_board = is_device_folder(entry->path().string());
        if (fs::is_directory(entry->path() / "incoming", unknown) || (is_board.ok() && is_board.value()))
            boards.push_back({name, entry->path().string()});
    }
    if (error)
        return failure(Fault::kNoInput, "%s: it cannot be read (%s)", shown(archive).c_str(), error.message().c_str());
    std::ranges::sort(boards, {}, &DeviceFolder::device);
    return boards;
}

} // namespace dicot::app
