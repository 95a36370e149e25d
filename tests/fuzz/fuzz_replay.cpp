// Any text as the script of a replay.
#include "dicot/replay/replay_script.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace {

void require(bool promise)
{
    if (!promise)
        std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot;
    const std::string_view text{static_cast<const char*>(static_cast<const void*>(data)), size};
    const Result<ReplayScript> got = parse_replay_script(text, "fuzz");
    if (!got.ok()) {
        require(got.status().fault() == Fault::kConfig);
        for (const char* c = got.status().message(); *c != '\0'; ++c)
            require(*c >= ' ' && *c <= '~');
        return 0;
    }
    const ReplayScript& script = got.value();
    require(script.interval_100ns >= 10'000'000 / 240 && script.interval_100ns <= 10'000'000);
    require(script.event_count >= 0 && script.event_count <= ReplayScript::kMostEvents);
    require(script.control_count >= 0 && script.control_count <= kControlCount);
    for (int i = 0; i < script.control_count; ++i) {
        const ControlRange& range = script.controls[static_cast<std::size_t>(i)].range;
        require(range.least <= range.usual && range.usual <= range.most && range.step >= 1);
        const std::int32_t value = nearest_value(range, range.usual);
        require(value >= range.least && value <= range.most);
    }
    return 0;
}
