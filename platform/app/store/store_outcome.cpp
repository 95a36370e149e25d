#include "store_outcome.h"

#include "shown.h"

#include <cstdio>
#include <string_view>

namespace dicot::app {
namespace {

int weight(const Status& status)
{
    return status.ok() ? -1 : status.fault() == Fault::kTryAgain ? 0 : status.exit_code();
}

} // namespace

Status in_store(const std::string& path, const Status& status)
{
    const std::string folder = shown(path);
    const std::string_view message = status.message();
    if (status.ok() || message.starts_with(path) || message.starts_with(folder))
        return status;
    return failure(status.fault(), "%s: %s", folder.c_str(), status.message());
}

StoreOutcome::StoreOutcome(const FoundStores& found)
{
    for (const UnreadFolder& folder : found.unread)
        add(folder.why);
}

void StoreOutcome::add(const Status& status)
{
    const bool is_worse = weight(status) > weight(worst_);
    const Status& other = is_worse ? worst_ : status;
    if (!other.ok())
        std::fprintf(stderr, "dicot: %s\n", other.message());
    if (is_worse)
        worst_ = Status{status};
}

} // namespace dicot::app
