#include "pull_job.h"

#include "../config/device_name.h"
#include "../store/shown.h"
#include "../store/store_words.h"

#include "dicot/medium/disk_medium.h"
#include "dicot/pull_archive/folder_source.h"
#include "dicot/record/record.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

namespace dicot::app {
namespace {

namespace fs = std::filesystem;

/// Where the service of the package keeps them, on a card that holds a whole system.
constexpr const char* kOnACard = "var/lib/dicot/clouds";

/// The board's name in the record of a snapshot; empty: it does not say.
std::string name_in(PullSource& source, const OfferedSnapshot& snapshot)
{
    std::vector<std::byte> text(kMaxRecordBytes);
    std::size_t got = 0;
    const Status looked = source.files(snapshot, [&](const OfferedFile& file) {
        if (file.name.view() != "record.json")
            return true;
        if (const auto read = source.read(file, 0, text); read.ok())
            got = read.value();
        return false;
    });
    const auto* const begin = reinterpret_cast<const char*>(text.data());
    const nlohmann::json record = nlohmann::json::parse(begin, begin + got, nullptr, false);
    if (!looked.ok() || !record.is_object() || !record.contains("device") || !record["device"].is_string())
        return {};
    const std::string name = record["device"].get<std::string>();
    return is_device_name(name) ? name : std::string{};
}

/// The board's name as one of its first records has it; empty: nobody says. The catalogue is left alone: SQLite writes
/// beside what it reads.
Result<std::string> recorded_name(const std::string& path)
{
    constexpr int kMostAsked = 16;
    std::unique_ptr<Medium> medium = TRY(open_disk_medium(path));
    const auto source = TRY(open_folder_source(std::move(medium), "unknown", path));
    std::vector<OfferedSnapshot> first;
    TRY(source->snapshots(0, [&](const OfferedSnapshot& snapshot) {
        first.push_back(snapshot);
        return first.size() < kMostAsked;
    }));
    std::string name;
    for (auto snapshot = first.begin(); name.empty() && snapshot != first.end(); ++snapshot)
        name = name_in(*source, *snapshot);
    return name;
}

/// What its records say; else what its folder is called; empty: neither is a board's name.
Result<std::string> name_of(const std::string& path)
{
    if (std::string recorded = TRY(recorded_name(path)); !recorded.empty())
        return recorded;
    const std::string folder = fs::path(path + "/").parent_path().filename().string();
    return is_device_name(folder) ? folder : std::string{};
}

Result<std::vector<DeviceFolder>> boards_in(const std::string& folder)
{
    std::vector<DeviceFolder> boards;
    if (TRY(is_device_folder(folder))) {
        const std::string name = TRY(name_of(folder));
        if (name.empty())
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
        if (!fs::is_directory(entry->symlink_status(unknown)))
            continue;
        const std::string path = entry->path().string();
        const Result<bool> is_board = is_device_folder(path);
        if (!is_board.ok() || !is_board.value())
            continue;
        if (std::string board = TRY(name_of(path)); !board.empty())
            boards.push_back({std::move(board), path});
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
