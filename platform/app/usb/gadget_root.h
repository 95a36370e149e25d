// What root does for the process that serves: before it and after it.
#pragma once

#include "gadget_server.h"
#include "server_page.h"

namespace dicot::app {

/// The page of whoever serves, its lock ours. By root: the gadget is prepared as well, and this process becomes who the
/// store belongs to. Fault::kTryAgain: somebody serves; kUnavailable: not prepared. Errors: those of prepare_gadget().
Result<ServerPage> prepared_page(const ServerWish& wish, UsbGadget& gadget);

} // namespace dicot::app
