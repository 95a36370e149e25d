// dicot gadget: the board as a device from which any computer takes clouds home.
#include "commands.h"
#include "config_words.h"
#include "store/slot_words.h"
#include "usb/clock_offer.h"
#include "usb/gadget_server.h"
#include "usb/gadget_status.h"

#include <cstdio>
#include <memory>

namespace dicot::app {
namespace {

struct GadgetCommandWords
{
    ConfigWords config;
    std::string root;
    bool json = false;
    bool if_wanted = false;
};

using Work = Status (*)(const ServerWish& wish, const GadgetCommandWords& words);

Status up(const ServerWish& wish, const GadgetCommandWords&)
{
    return serve_store(wish);
}

Status prepare(const ServerWish& wish, const GadgetCommandWords& words)
{
    if (words.if_wanted && !wish.config->usb.export_store)
        return {};
    return prepare_gadget(wish);
}

Status down(const ServerWish& wish, const GadgetCommandWords&)
{
    const TakenDown down = TRY(take_gadget_down(wish.places));
    if (down.server != 0)
        std::printf("process %d served, and has ended\n", static_cast<int>(down.server));
    std::printf("%s\n", down.gadget ? "the gadget is removed: no computer sees the clouds"
                                    : "there was no gadget: no computer sees the clouds");
    if (wish.config->usb.export_store)
        std::printf("the service serves again once it is restarted: systemctl restart dicot\n");
    return {};
}

Status tell(const ServerWish& wish, const GadgetCommandWords& words)
{
    const GadgetStatus status = gadget_status(wish.places, wish.config->usb.udc);
    std::printf("%s%s", words.json ? json_text(gadget_json(status)).c_str() : gadget_text(status).c_str(),
                words.json ? "\n" : "");
    if (!words.json && !wish.config->usb.export_store)
        std::printf(
            "service   shows nothing: usb.export = true in /etc/dicot/dicot.toml, then systemctl restart dicot\n");
    return {};
}

Status run(const GadgetCommandWords& words, Work work)
{
    const LoadedConfig loaded = TRY(words.config.load());
    ServerWish wish;
    wish.config = &loaded.config;
    wish.root = words.root;
    return work(wish, words);
}

/// An offer that nothing can judge is dropped all the same.
Status take_time(const GadgetCommandWords& words)
{
    const WaitingOffer offer = TRY(take_offer(kClockOfferFile));
    const LoadedConfig loaded = TRY(words.config.load());
    ServerWish wish;
    wish.config = &loaded.config;
    wish.root = words.root;
    return judge_and_set(offer, kClockOfferFile, loaded.config.usb.clock, board_store(wish).path);
}

void set(CLI::App& command, Command& chosen, const std::shared_ptr<GadgetCommandWords>& words, Work work)
{
    words->config.add_to(command);
    command.callback([words, work, &chosen] { chosen = [words, work] { return run(*words, work); }; });
}

void add_root(CLI::App& command, GadgetCommandWords& words)
{
    command.add_option("-o,--output,--store", words.root, "folder of the store, as for snap (default: output.folder)")
        ->type_name("DIR");
}

} // namespace

void add_gadget(CLI::App& program, Command& chosen)
{
    CLI::App* group = program.add_subcommand(
        "gadget",
        "This board as a USB device: a computer that is plugged into it sees the clouds, as those of a camera");
    group->require_subcommand(1);
    auto words = std::make_shared<GadgetCommandWords>();
    CLI::App* served = group->add_subcommand(
        "up", "Shows the store to computers, until 'down', SIGTERM or Ctrl-C; by root, or after 'prepare'");
    set(*served, chosen, words, up);
    add_root(*served, *words);
    set(*group->add_subcommand("down", "Ends who serves, and takes the gadget away; by root"), chosen, words, down);
    CLI::App* told = group->add_subcommand("status", "Whether a computer is there, who serves, and what was sent");
    set(*told, chosen, words, tell);
    told->add_flag("--json", words->json, "report as JSON");
    CLI::App* prepared = group->add_subcommand(
        "prepare", "Root's part alone: makes the gadget, and hands it to who the store belongs to");
    set(*prepared, chosen, words, prepare);
    add_root(*prepared, *words);
    prepared->add_flag("--if-wanted", words->if_wanted, "nothing unless usb.export is true");
    CLI::App* timed = group->add_subcommand(
        "take-time", "Root's part alone: the time that a computer offered becomes the board's, if the rules say yes");
    words->config.add_to(*timed);
    timed->callback([words, &chosen] { chosen = [words] { return take_time(*words); }; });
    add_root(*timed, *words);
}

} // namespace dicot::app
