#include "board_store.h"

#include "../config/device_name.h"
#include "../output_folder.h"
#include "../stop_request.h"
#include "shown.h"
#include "store_outcome.h"

#include "dicot/os/clock.h"
#include "dicot/os/host.h"
#include "dicot/os/stage_watch.h"

#include <chrono>
#include <filesystem>
#include <thread>

namespace dicot::app {

Result<BoardStore> BoardStore::make(const OutputConfig& output, const std::string& root)
{
    BoardStore board;
    board.root = root.empty() ? output.folder : root;
    board.device = output.device.empty() ? device_name_near(host_name()) : output.device;
    board.path = board.root + "/" + board.device;
    std::error_code ignored;
    if (std::filesystem::is_directory(board.root, ignored) && TRY(is_device_folder(board.root)))
        return failure(Fault::kUsage, "%s: this is the folder of one board: name the one around it",
                       shown(board.root).c_str());
    TRY(make_folder(board.root));
    TRY(make_folder(board.path));
    return board;
}

Result<WrittenStore> BoardStore::open_patiently(const StoreRules& rules) const
{
    constexpr std::int64_t kPatienceUs = 60'000'000;
    constexpr std::chrono::milliseconds kPause{50};
    const std::int64_t until_us = monotonic_us() + kPatienceUs;
    for (;;) {
        Result<WrittenStore> opened = WrittenStore::open(path, rules);
        if (opened.ok())
            return opened;
        if (opened.status().fault() != Fault::kTryAgain || StopRequest::asked() || monotonic_us() > until_us)
            return in_store(path, opened.status());
        StageWatch::progress();
        std::this_thread::sleep_for(kPause);
    }
}

} // namespace dicot::app
