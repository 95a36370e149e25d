#include "gadget_root.h"

#include "end_server.h"
#include "gadget_child.h"
#include "gadget_user.h"
#include "gadget_words.h"

#include "../config/device_name.h"

#include "dicot/os/clock.h"
#include "dicot/os/host.h"

#include <time.h>
#include <unistd.h>

namespace dicot::app {
namespace {

constexpr std::int64_t kMostEndUs = 15'000'000; ///< a mark that is being written is written to its end

/// With the page's lock held: nobody serves meanwhile.
Status prepare(const ServerWish& wish, UsbGadget& gadget, ServerPage& page, const GadgetUser& user)
{
    const BoardStore store = board_store(wish);
    (void)TRY(gadget.controller(wish.config->usb.udc));
    const std::string serial = TRY(serial_for(wish.config->usb));
    TRY(gadget.prepare(gadget_words(store.device, serial, DICOT_VERSION), user.user, user.group));
    return page.hand_to(user.user, user.group);
}

Result<ServerPage> take_page(const GadgetPlaces& places)
{
    if (::geteuid() == 0)
        TRY(UsbGadget(places).make_run_folder());
    return ServerPage::take(places.server());
}

/// Whether it has ended.
bool await_end(const std::string& page)
{
    const std::int64_t until_us = monotonic_us() + kMostEndUs;
    while (server_of(page) != 0) {
        if (monotonic_us() > until_us)
            return false;
        const timespec pause{0, 50'000'000};
        ::nanosleep(&pause, nullptr);
    }
    return true;
}

} // namespace

BoardStore board_store(const ServerWish& wish)
{
    const OutputConfig& output = wish.config->output;
    BoardStore store;
    store.root = wish.root.empty() ? output.folder : wish.root;
    store.device = output.device.empty() ? device_name_near(host_name()) : output.device;
    store.path = store.root + "/" + store.device;
    return store;
}

Status prepare_gadget(const ServerWish& wish)
{
    if (::geteuid() != 0)
        return failure(Fault::kUnavailable, "only root can make a USB gadget: run 'dicot gadget prepare' as root");
    UsbGadget gadget(wish.places);
    ServerPage page = TRY(take_page(wish.places));
    return prepare(wish, gadget, page, user_for(board_store(wish).root));
}

Result<ServerPage> prepared_page(const ServerWish& wish, UsbGadget& gadget)
{
    if (::geteuid() != 0 && !gadget.prepared())
        return failure(Fault::kUnavailable,
                       "%s is not mounted: run 'dicot gadget prepare' as root first, or all of it as "
                       "root",
                       wish.places.mount().c_str());
    ServerPage page = TRY(take_page(wish.places));
    if (::geteuid() == 0) {
        const GadgetUser user = user_for(board_store(wish).path);
        TRY(prepare(wish, gadget, page, user));
        TRY(become(user));
        end_with_parent();
    }
    return page;
}

Result<TakenDown> take_gadget_down(const GadgetPlaces& places)
{
    const pid_t server = TRY(end_server(places.server()));
    if (server != 0 && !await_end(places.server()))
        return failure(Fault::kTryAgain, "process %d was told to end and has not yet", static_cast<int>(server));
    const bool was_there = UsbGadget(places).there();
    TRY(UsbGadget(places).remove());
    return TakenDown{server, was_there};
}

} // namespace dicot::app
