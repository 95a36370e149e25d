#include "descriptors.h"
#include "hub.h"
#include "options.h"

#include <cstdio>

namespace {

dicot::Status run(std::span<const char* const> words)
{
    using namespace dicot::usbip;
    const Options options = TRY(read_options(words));
    Hub hub(options.bus_bytes);
    for (const CameraWish& wish : options.cameras)
        TRY(hub.add(wish));
    if (options.descriptors_only) {
        const Bytes bytes = configuration_descriptor(hub.camera(0).model());
        std::fwrite(bytes.data(), 1, bytes.size(), stdout);
        return {};
    }
    if (!options.plan.empty())
        TRY(hub.read_plan(options.plan));
    if (!options.commands.empty())
        TRY(hub.open_commands(options.commands));
    return hub.run();
}

} // namespace

int main(int argc, char** argv)
{
    const dicot::Status status = run({argv + 1, static_cast<std::size_t>(argc > 0 ? argc - 1 : 0)});
    if (!status.ok())
        std::fprintf(stderr, "usbip_camera: %s\n", status.message());
    return status.exit_code();
}
