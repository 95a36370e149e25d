#include "view_words.h"

#include "../store/store_words.h"

namespace dicot::app {

void add_view_words(CLI::App& program, Command& chosen, const std::function<Status(const ViewWords&)>& run)
{
    constexpr int kMostPort = 65535;
    CLI::App* command = program.add_subcommand(
        "view", "Clouds, leaves, traits and growth on a page in the browser, on this computer alone");
    auto words = std::make_shared<ViewWords>();
    command->add_option("ARCHIVE", words->path,
                        "an archive, a store, or one cloud file (default: dicot-clouds in your home)");
    command->add_option("--port", words->port, "of 127.0.0.1 (default: any that is free)")
        ->check(CLI::Range(0, kMostPort))
        ->type_name("N");
    command->add_flag("--no-open", words->no_open, "print the address and open no browser");
    command->add_option("--last", words->last, "the newest slots alone, so many of each board")
        ->transform(slot_number());
    command
        ->add_option("--plants", words->places,
                     "plants by name: CSV with name, min_x_mm .. max_z_mm, boxes in the ground frame")
        ->type_name("FILE");
    command->add_option("--export", words->export_folder, "write the page and its data as files, and serve nothing")
        ->type_name("DIR");
    command->callback([words, run, &chosen] { chosen = [words, run] { return run(*words); }; });
}

} // namespace dicot::app
