// dicot aim: focus, light, overlap and rotation of both cameras, live.
#include "aim/aim_run.h"
#include "commands.h"
#include "config_words.h"

#include <memory>

namespace dicot::app {
namespace {

struct AimWords
{
    ConfigWords config;
    double seconds = 0;
    bool json = false;
};

Status run(const AimWords& words)
{
    const LoadedConfig loaded = TRY(words.config.load());
    return aim(loaded.config, words.seconds, words.json);
}

} // namespace

void add_aim(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand(
        "aim", "Live figures of both cameras, to turn and focus them by: what is wrong, and what to do about it");
    auto words = std::make_shared<AimWords>();
    words->config.add_to(*command);
    command->add_option("--seconds", words->seconds, "ends after so long; else with Ctrl-C")
        ->check(CLI::Range(0.1, 1e6));
    command->add_flag("--json", words->json, "one JSON object a line, one a second");
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
