// What root asks of the kernel before there can be a gadget.
#pragma once

#include "dicot/base/status.h"

#include <string>
#include <sys/types.h>

namespace dicot::gadget_parts {

/// configfs with its folder usb_gadget, below `config`. Fault::kUnavailable: this kernel has none; not root.
Status provide_configfs(const std::string& config);
/// A folder, no link to one, that is this user's and that nobody else may write, whatever the mask; made if it is
/// missing. Fault::kUnavailable: not this user's to make so; kOsError: it is something else.
Status own_folder(const std::string& path);
/// An instance of FunctionFS, handed to `user`; what was mounted there before goes. Fault::kUnavailable, kOsError.
Status mount_functionfs(const std::string& name, const std::string& folder, uid_t user, gid_t group);
/// Nothing if nothing is mounted there. Fault::kOsError.
Status unmount_functionfs(const std::string& folder);
bool is_functionfs(const std::string& folder);

} // namespace dicot::gadget_parts
