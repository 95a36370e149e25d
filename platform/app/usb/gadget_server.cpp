#include "gadget_server.h"

#include "gadget_child.h"
#include "gadget_root.h"
#include "gadget_words.h"
#include "server_page.h"
#include "shelf_objects.h"

#include "../run/journal.h"
#include "../run/run_memory.h"
#include "../stop_request.h"

#include "dicot/gadget/ffs_link.h"
#include "dicot/os/process_memory.h"
#include "dicot/os/service_notice.h"
#include "dicot/os/wait.h"

#include <cinttypes>
#include <cstdio>
#include <filesystem>

namespace dicot::app {
namespace {

constexpr std::size_t kKiB = 1024;
/// Of the main thread, while it serves: names that are longer than what std::string holds in itself.
constexpr std::size_t kOfficeBytes = 64 * kKiB;
constexpr std::size_t kLibrariesBytes = 128 * kKiB;
/// Pages of code that nothing has touched before the seal (SQLite's, when marks are written), and stacks.
constexpr std::size_t kWorkingBytes = 1536 * kKiB;
constexpr int kLookMs = 5000; ///< without a host: whether the controller still has the gadget

bool goes_on()
{
    return !StopRequest::asked();
}

/// In bytes, of what is taken already and what may come.
std::size_t most_resident(const ProcessMemory& now, const ShelfBudget& shelf)
{
    return static_cast<std::size_t>(now.resident_bytes) + shelf.resident() + kOfficeBytes + kLibrariesBytes +
           kWorkingBytes;
}

RunBudget budget_of(const ShelfBudget& shelf)
{
    RunBudget budget;
    budget.pages = shelf.pages;
    budget.office.mapped = budget.office.resident = kOfficeBytes;
    budget.libraries.mapped = budget.libraries.resident = kLibrariesBytes;
    return budget;
}

void copy(const mtp::ResponderCounts& from, const CableCounts& cable, ServerFigures& to)
{
    to.session_open = from.session_open ? 1 : 0;
    to.sessions = from.sessions;
    to.requests = from.requests;
    to.refused = from.refused;
    to.cancelled = from.cancelled;
    to.objects_sent = from.objects_sent;
    to.bytes_sent = from.bytes_sent;
    to.marked = from.marked;
    to.hosts = cable.hosts.load();
    to.resets = cable.resets.load();
    to.given_up = cable.given_up.load();
    to.events_dropped = cable.events_dropped.load();
}

/// What serving is made of.
struct Server
{
    UsbGadget& gadget;
    std::string controller;
    FfsLink& link;
    const ShelfObjects& objects;
    mtp::Responder& responder;
    ServerFigures& figures;
    std::uint64_t sessions_told = 0;
    bool controller_went = false;
    ShortText<255> hidden_told{};

    /// A controller that went (its driver was unloaded, its port became a host's) has let go of the gadget. What
    /// somebody unbound by hand stays so.
    void keep_bound()
    {
        const bool there = controller_there(gadget.places(), controller.c_str());
        if (there && controller_went && gadget.bind(controller.c_str()).ok())
            journal(Priority::kNotice, "the USB device port %s is there again", controller.c_str());
        controller_went = !there;
    }

    void tell_hidden()
    {
        const ShortText<255> words = hidden_words(objects.hidden());
        if (words.view() != hidden_told.view() && !words.view().empty())
            journal(Priority::kNotice, "%s", words.c_str());
        hidden_told = words;
    }

    void tell()
    {
        tell_hidden();
        const mtp::ResponderCounts& counts = responder.counts();
        copy(counts, link.counts(), figures);
        if (counts.sessions != sessions_told && !counts.session_open) {
            sessions_told = counts.sessions;
            journal(Priority::kInfo,
                    "a computer has ended its session: %" PRIu64 " files and %" PRIu64 " bytes sent, %" PRIu64
                    " snapshots marked since the start",
                    counts.objects_sent, counts.bytes_sent, counts.marked);
        }
    }

    void serve_host()
    {
        while (goes_on() && responder.serve_one().ok())
            tell();
        responder.forget();
        tell();
    }

    Status serve()
    {
        tell_hidden();
        while (goes_on()) {
            const Status host = link.await_host(kLookMs);
            if (host.ok())
                serve_host();
            else if (host.fault() == Fault::kTryAgain)
                keep_bound();
        }
        return {};
    }
};

Status check_store(const BoardStore& store)
{
    if (std::error_code why; !std::filesystem::is_directory(store.path, why))
        return failure(Fault::kUnavailable, "%s: there is no store yet: dicot run or dicot snap makes it",
                       store.path.c_str());
    return {};
}

} // namespace

Status serve_store(const ServerWish& wish)
{
    RunMemory::keep_address_space_known();
    const StopRequest stop;
    live_with_parent();
    UsbGadget gadget(wish.places);
    const BoardStore store = board_store(wish);
    TRY(check_store(store));
    const std::string controller = TRY(gadget.controller(wish.config->usb.udc));
    const std::string serial = TRY(serial_for(wish.config->usb));
    ServerPage page = TRY(prepared_page(wish, gadget));

    ShelfSettings settings;
    settings.path = store.path;
    settings.device = store.device;
    settings.rules = rules_of(wish.config->output);
    settings.marks = wish.config->usb.marks;
    settings.clock_rule = wish.config->usb.clock;
    const std::unique_ptr<ShelfObjects> objects = TRY(ShelfObjects::open(settings));
    const MemoryBlock room = TRY(MemoryBlock::map(mtp::Responder::kRoomBytes, Pages::kResident));
    const std::string mount = gadget.places().mount();
    const auto may_go_on = [] { return goes_on(); };
    const std::unique_ptr<FfsLink> link = TRY(FfsLink::open({mount.c_str(), may_go_on}));
    const auto responder = std::make_unique<mtp::Responder>(
        *objects, *link, device_words(store.device, serial, DICOT_VERSION), room.bytes());
    const ShelfBudget shelf = shelf_budget(settings.limits);
    const std::unique_ptr<RunMemory> memory = TRY(RunMemory::carve(budget_of(shelf)));
    ServiceNotice notice;
    TRY(notice.open());

    ServerFigures& figures = page.figures();
    figures.fixed_bytes = most_resident(TRY(process_memory()), shelf);
    figures.began_us = static_cast<std::uint64_t>(utc_now_us());
    std::printf("a computer that is plugged into %s will see the board \"%s\", serial number %s, with the clouds of "
                "%s; memory is fixed: %.1f MiB "
                "at most\n",
                controller.c_str(), store.device.c_str(), serial.c_str(), store.path.c_str(),
                static_cast<double>(figures.fixed_bytes) / (1024 * 1024));
    std::fflush(stdout);
    Server server{gadget, controller, *link, *objects, *responder, figures};
    memory->seal();
    TRY(gadget.bind(controller.c_str()));
    figures.magic = ServerFigures::kMagic;
    notice.ready();
    const Status served = server.serve();
    notice.stopping();
    (void)gadget.unbind();
    return served;
}

} // namespace dicot::app
