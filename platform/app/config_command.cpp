// dicot config: what holds, where it comes from, and what could be said.
#include "commands.h"
#include "config/config_text.h"
#include "config_json.h"
#include "config_words.h"

#include <cstdio>
#include <filesystem>
#include <memory>

namespace dicot::app {
namespace {

struct ConfigCommandWords
{
    ConfigWords config;
    bool json = false;
    bool sample = false;
};

Status run(const ConfigCommandWords& words)
{
    if (words.sample) {
        std::fputs(config_sample().c_str(), stdout);
        return {};
    }
    const LoadedConfig loaded = TRY(words.config.load());
    std::error_code error;
    const std::string here = std::filesystem::current_path(error).string();
    if (error)
        return failure(Fault::kOsError, "the folder that dicot was started in is gone: change to another one");
    std::fputs((words.json ? config_json(loaded, here) : config_toml(loaded, here)).c_str(), stdout);
    return {};
}

} // namespace

void add_config(CLI::App& program, Command& chosen)
{
    CLI::App* command =
        program.add_subcommand("config", "The configuration that holds: each key with unit, default, range and origin");
    auto words = std::make_shared<ConfigCommandWords>();
    words->config.add_to(*command);
    CLI::Option* json = command->add_flag("--json", words->json, "report as JSON");
    CLI::Option* sample =
        command->add_flag("--sample", words->sample, "a file to begin with: every key as a remark, with its default");
    sample->excludes(json)->excludes(command->get_option("--config"));
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
