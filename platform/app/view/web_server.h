// The site at an address of this computer.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/base/status.h"

namespace dicot::app {

class ViewSite;

/// Answers GET and HEAD on 127.0.0.1 until a StopRequest, of which one must live, is asked. `port` 0: any that is free.
/// `ready` is told which. A request whose Host is not this computer is refused, so that no page of another name reaches
/// the site (DNS rebinding). Fault::kUnavailable: the port is taken.
Status serve(ViewSite& site, int port, FunctionRef<void(int port)> ready);

} // namespace dicot::app
