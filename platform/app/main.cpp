#include "commands.h"

#include <csignal>
#include <cstdio>
#include <string>

namespace {

constexpr const char* kFooter =
    "Exit codes follow sysexits(3): 0 done, 64 usage, 65 bad data, 66 no input, 69 unavailable, "
    "70 fault of dicot, 71 system refused,\n73 cannot create, 74 I/O error, 75 try again, 78 configuration.";

/// One sentence, as for every other fault.
int misused(const CLI::App& program, const CLI::ParseError& error)
{
    std::string words = "dicot";
    for (const CLI::App* app = &program; !app->get_subcommands().empty();) {
        app = app->get_subcommands().front();
        words += " " + app->get_name();
    }
    std::fprintf(stderr, "dicot: %s: see '%s --help'\n", error.what(), words.c_str());
    return static_cast<int>(dicot::Fault::kUsage);
}

} // namespace

int main(int argc, char** argv)
{
    using namespace dicot;
    // A limit of the file size (ulimit -f) is an error of writing, no end.
    (void)std::signal(SIGXFSZ, SIG_IGN);
    CLI::App program{"dicot: two webcams beside the plants, and a compressed 3D cloud of them."};
    program.set_version_flag("--version", "dicot " DICOT_VERSION);
    program.footer(kFooter);
    program.require_subcommand(1);

    app::Command chosen;
    app::add_accuracy(program, chosen);
    app::add_aim(program, chosen);
    app::add_bench(program, chosen);
    app::add_calibrate(program, chosen);
    app::add_config(program, chosen);
    app::add_capture(program, chosen);
    app::add_match(program, chosen);
    app::add_plant(program, chosen);
    app::add_probe(program, chosen);
    app::add_process(program, chosen);
    app::add_rectify(program, chosen);
    app::add_rig(program, chosen);
    app::add_export(program, chosen);
    app::add_info(program, chosen);
    app::add_evaluate(program, chosen);
    app::add_memory(program, chosen);
    app::add_selftest(program, chosen);
    app::add_run(program, chosen);
    app::add_schedule(program, chosen);
    app::add_snap(program, chosen);
    app::add_gadget(program, chosen);
    app::add_list(program, chosen);
    app::add_health(program, chosen);
    app::add_diag(program, chosen);
    app::add_show(program, chosen);
    app::add_verify(program, chosen);
    app::add_prune(program, chosen);
    app::add_pull(program, chosen);
    app::add_archive(program, chosen);
    app::add_view(program, chosen);
    app::add_traits(program, chosen);

    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) // --help, --version
            return program.exit(error);
        return misused(program, error);
    }
    Status status = chosen();
    if (status.ok() && (std::fflush(stdout) != 0 || std::ferror(stdout) != 0))
        status = failure(Fault::kIoError, "standard output cannot be written: the disk is full, or its reader is gone");
    if (!status.ok())
        std::fprintf(stderr, "dicot: %s\n", status.message());
    return status.exit_code();
}
