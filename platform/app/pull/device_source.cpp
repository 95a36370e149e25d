#include "device_source.h"

#include "board_source.h"
#include "device_talk.h"
#include "find_boards.h"
#include "tree_source.h"

namespace dicot::app {
namespace {

constexpr int kMostWalks = 2; ///< again

} // namespace

Result<PullSources> sources_behind(std::unique_ptr<mtp::UsbPipe> pipe, const mtp::MtpListed& listed,
                                   const mtp::Initiator::Patience& patience)
{
    auto talk = std::make_shared<DeviceTalk>(std::move(pipe), listed, patience);
    TRY(talk->open());
    PullSources sources;
    if (talk->initiator().facts().lists_snapshots) {
        sources.push_back(TRY(open_board(talk)));
        return sources;
    }
    std::vector<BoardFolder> folders;
    Status found = find_boards(*talk, folders);
    // A session that broke meanwhile took the handles with it.
    for (int round = 0; round < kMostWalks && found.fault() == Fault::kTryAgain; ++round)
        found = find_boards(*talk, folders);
    TRY(found);
    for (const BoardFolder& folder : folders)
        sources.push_back(open_tree(talk, folder));
    return sources;
}

Result<PullSources> open_device(const mtp::MtpListed& listed, mtp::StopAsked stop)
{
    return sources_behind(TRY(mtp::open_usb_pipe(listed, stop)), listed);
}

} // namespace dicot::app
