// The page and its data as a folder of files, to be opened without a server.
#pragma once

#include "dicot/base/status.h"

#include <string>

namespace dicot::app {

class ViewSite;

/// Pictures as they are, everything else as script files, because a page that is opened as a file may not read others.
/// `folder` is made unless it is there; files in it are replaced. Fault::kCannotCreate, kIoError; kTryAgain: somebody
/// wanted an end, and the page is not written.
Status export_site(ViewSite& site, const std::string& folder);

} // namespace dicot::app
