#include "pull_job.h"

#include "../config/device_name.h"
#include "../store/shown.h"
#include "../store/store_words.h"

#include "dicot/medium/disk_medium.h"
#include "dicot/pull_archive/folder_source.h"
#include "dicot/store/look.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

namespace dicot::app {
namespace {

namespace fs = std::filesystem;

/// Where the service of the package keeps them, on a card that holds a whole system.
constexpr const char* kOnACard = "var/lib/dicot/clouds";

/// The board's name as its newest readable record has it; empty: nobody says.
Result<std::string> recorded_name(const std::string& path)
{
    const ReadStore store = TRY(ReadStore::open(path));
    std::string name;
    TRY(store.catalogue->for_each({}, [&](const SlotRow& row) {
        if (row.kept != Kept::kHere)
            return true;
        const Result<std::string> text = read_record_text(*store.medium, row);
        if (!text.ok())
            return true;
        const nlohmann::json record = nlohmann::json::parse(text.value(), nullptr, false);
        if (record.is_object() && record.contains("device") && record["device"].is_string())
            name = record["device"].get<std::string>();
        return !is_device_name(name);
    }));
    return is_device_name(name) ? name : std::string{};
}

Result<std::vector<DeviceFolder>> boards_in(const std::string& folder)
{
    std::vector<DeviceFolder> boards;
    if (TRY(is_device_folder(folder))) {
        std::string name = TRY(recorded_name(folder));
        if (name.empty())
            name = fs::path(folder + "/").parent_path().filename().string();
        if (!is_device_name(name))
            return failure(Fault::kBadData,
                           "%s: no record in it says what the board is called: name the folder as the board is",
                           shown(folder).c_str());
        boards.push_back({name, folder});
        return boards;
    }
    std::error_code error;
    for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator{};
         entry.increment(error)) {
        std::error_code unknown;
        const std::string name = entry->path().filename().string();
        if (!fs::is_directory(entry->symlink_status(unknown)) || !is_device_name(name))
            continue;
        const Result<bool> is_board = is_device_folder(entry->path().string());
        if (is_board.ok() && is_board.value())
            boards.push_back({name, entry->path().string()});
    }
    std::ranges::sort(boards, {}, &DeviceFolder::device);
    return boards;
}

PullJob job_of(const DeviceFolder& board)
{
    return {board.path, [board]() -> Result<std::vector<std::unique_ptr<PullSource>>> {
                std::vector<std::unique_ptr<PullSource>> sources;
                std::unique_ptr<Medium> medium = TRY(open_disk_medium(board.path));
                sources.push_back(TRY(open_folder_source(std::move(medium), board.device, board.path)));
                return sources;
            }};
}

} // namespace

Result<std::vector<PullJob>> jobs_of_folder(const std::string& folder, const std::string& device)
{
    std::error_code error;
    if (!fs::is_directory(folder, error))
        return failure(Fault::kNoInput, "%s: this is no folder: name a board's folder, one around several, or a card",
                       shown(folder).c_str());
    std::vector<DeviceFolder> boards = TRY(boards_in(folder));
    if (const fs::path inside = fs::path(folder) / kOnACard; boards.empty() && fs::is_directory(inside, error))
        boards = TRY(boards_in(inside.string()));
    if (!device.empty())
        std::erase_if(boards, [&](const DeviceFolder& board) { return board.device != device; });
    if (boards.empty())
        return failure(Fault::kNoInput, "%s: there is no board's folder in it%s%s", shown(folder).c_str(),
                       device.empty() ? "" : " of the name ", shown(device).c_str());
    std::vector<PullJob> jobs;
    for (const DeviceFolder& board : boards)
        jobs.push_back(job_of(board));
    return jobs;
}

} // namespace dicot::app
