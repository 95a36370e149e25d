// A computer that is not dicot's, for the board on the other end of the cable.
//
//   trial_host speed [MIB]        the largest file as a whole, until so much went over (16): bytes, milliseconds
//   trial_host sessions N         opens and closes so many; each tenth on a device that is opened anew
//   trial_host hostile SEED N     what is written down in rough_host.cpp, and N trials of chance
//   trial_host reset              resets the port
//
// Exit code 1 when the device does not do what it has to.
#include "rough_host.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>

namespace {

using namespace trial;
using Clock = std::chrono::steady_clock;

int fail(const char* what)
{
    std::printf("%s\n", what);
    return 1;
}

int speed(std::uint64_t mib)
{
    StillImage device;
    if (!device.open_session())
        return fail("no session");
    std::uint64_t bytes = 0;
    const std::uint32_t large = device.largest(bytes);
    if (large == 0)
        return fail("no file");
    const auto start = Clock::now();
    std::uint64_t sum = 0;
    while (sum < mib << 20) {
        const Answer object = device.ask(kGetObject, {large});
        if (object.code != kOk || object.data_bytes != bytes)
            return fail("the file did not come whole");
        sum += object.data_bytes;
    }
    const auto took = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - start);
    std::printf("%llu %lld\n", static_cast<unsigned long long>(sum), static_cast<long long>(took.count()));
    device.ask(kCloseSession);
    return 0;
}

int sessions(int count)
{
    std::optional<StillImage> device;
    for (int i = 0; i < count; ++i) {
        if (i % 10 == 0) {
            device.reset();
            device.emplace();
            if (i == 0 && device->open_session())
                device->ask(kCloseSession);
        }
        if (device->ask(kOpenSession, {static_cast<std::uint32_t>(i + 1)}).code != kOk)
            return fail("a session did not open");
        if (device->ask(kGetStorageIds).data_bytes != 8)
            return fail("a session has no storage");
        // Each seventh ends by going away.
        if (i % 7 == 6 && !device->reset_and_wait())
            return fail("it is not ready again after a reset");
        if (i % 7 != 6 && device->ask(kCloseSession).code != kOk)
            return fail("a session did not close");
    }
    std::printf("%d sessions\n", count);
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    const char* what = argc > 1 ? argv[1] : "";
    const auto word = [&](int at, const char* otherwise) {
        return std::strtoull(argc > at ? argv[at] : otherwise, nullptr, 10);
    };
    if (std::strcmp(what, "speed") == 0)
        return speed(word(2, "16"));
    if (std::strcmp(what, "sessions") == 0)
        return sessions(static_cast<int>(word(2, "1000")));
    if (std::strcmp(what, "hostile") == 0) {
        StillImage device(2000);
        return be_hostile(device, word(2, "1"), static_cast<int>(word(3, "50"))) ? 0 : 1;
    }
    if (std::strcmp(what, "reset") == 0) {
        StillImage device;
        return device.port_reset() ? 0 : 1;
    }
    std::fprintf(stderr, "trial_host: see its first lines\n");
    return 64;
}
