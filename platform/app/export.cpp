// dicot export: a cloud file as other programs open it.
#include "cloud_on_disk.h"
#include "commands.h"

#include "dicot/export/export_cloud.h"

#include <cstdio>
#include <memory>
#include <string>

namespace dicot::app {
namespace {

struct ExportWords
{
    std::string cloud, output;
};

Status run(const ExportWords& words)
{
    if (!words.output.ends_with(".ply") && !words.output.ends_with(".pcd"))
        return failure(Fault::kUsage, "%s: the name must end in .ply or .pcd", words.output.c_str());
    const CloudOnDisk read = TRY(CloudOnDisk::read(words.cloud.c_str()));
    TRY(export_cloud(words.output.c_str(), read.cloud(), read.meta()));
    std::printf("%s: %zu points\n", words.output.c_str(), read.cloud().points.size());
    return {};
}

} // namespace

void add_export(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("export", "A cloud file as .ply or .pcd");
    auto words = std::make_shared<ExportWords>();
    command->add_option("CLOUD", words->cloud, "cloud file, .drc")->required();
    command->add_option("-o,--output", words->output, "the file to write: .ply or .pcd")->required();
    command->callback([words, &chosen] { chosen = [words] { return run(*words); }; });
}

} // namespace dicot::app
