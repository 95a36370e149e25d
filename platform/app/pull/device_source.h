// A device on the cable as a source of snapshots.
#pragma once

#include "dicot/mtp_host/initiator.h"
#include "dicot/mtp_host/mtp_list.h"
#include "dicot/mtp_host/usb_pipe.h"
#include "dicot/pull_archive/pull_source.h"

#include <memory>
#include <vector>

namespace dicot::app {

using PullSources = std::vector<std::unique_ptr<PullSource>>;

/// One source for each board whose folder stands on the device; none is no fault. Our own boards list their snapshots
/// themselves; the tree of any other device is walked (8 folders deep at most) for folders
/// DEVICE/YYYY-MM-DD/SEQUENCE_TIME. The sources share one conversation: all of them belong to one thread, and the
/// device is let go with the last. Faults as open_usb_pipe() and Initiator have them.
Result<PullSources> open_device(const mtp::MtpListed& listed, mtp::StopAsked stop);

/// The same through any pipe.
Result<PullSources> sources_behind(std::unique_ptr<mtp::UsbPipe> pipe, const mtp::MtpListed& listed,
                                   const mtp::Initiator::Patience& patience = {});

} // namespace dicot::app
