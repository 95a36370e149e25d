// The process that shows the store to computers: made, sealed, and then one request after the other.
#pragma once

#include "../config/config.h"
#include "../store/board_store.h"

#include "dicot/gadget/usb_gadget.h"

#include <string>
#include <sys/types.h>

namespace dicot::app {

struct ServerWish
{
    const Config* config = nullptr;
    std::string root; ///< of the store, instead of output.folder, if it is not empty
    GadgetPlaces places{};
};

/// The folder of the store and the name of the board in it, without making anything.
BoardStore board_store(const ServerWish& wish);

/// Root's part, for whoever the store belongs to. Fault::kTryAgain: somebody serves. Else as UsbGadget::prepare().
Status prepare_gadget(const ServerWish& wish);

/// Until SIGTERM, SIGINT or SIGHUP. By root: prepares first, and then becomes who the store belongs to.
/// Fault::kTryAgain: somebody serves already; kUnavailable: no port, not prepared, no store yet. Errors: those of
/// UsbGadget and FfsLink.
Status serve_store(const ServerWish& wish);

struct TakenDown
{
    pid_t server = 0;    ///< that was ended; 0: nobody served
    bool gadget = false; ///< there was one to remove
};
/// Ends who serves, and waits for it; removes the gadget. Fault::kUnavailable: not root, or who holds the server's lock
/// is not this program. Nothing to do is no fault.
Result<TakenDown> take_gadget_down(const GadgetPlaces& places);

} // namespace dicot::app
