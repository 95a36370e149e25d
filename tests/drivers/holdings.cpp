#include "holdings.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dirent.h>

namespace dicot {
namespace {

[[noreturn]] void give_up(const char* path)
{
    std::fprintf(stderr, "%s cannot be read; is /proc mounted?\n", path);
    std::exit(74);
}

template <typename OfLine>
void each_line(const char* path, OfLine of_line)
{
    std::FILE* file = std::fopen(path, "re");
    if (file == nullptr)
        give_up(path);
    char line[512];
    while (std::fgets(line, sizeof line, file) != nullptr)
        of_line(line);
    std::fclose(file);
}

} // namespace

Holdings Holdings::now()
{
    Holdings held;
    DIR* folder = ::opendir("/proc/self/fd");
    if (folder == nullptr)
        give_up("/proc/self/fd");
    while (const dirent* entry = ::readdir(folder)) // NOLINT(concurrency-mt-unsafe)
        held.descriptors += entry->d_name[0] != '.' ? 1 : 0;
    ::closedir(folder);

    each_line("/proc/self/maps", [&](const char* line) { held.maps += std::strchr(line, '\n') != nullptr ? 1 : 0; });
    // Not VmRSS: before Linux 6.2 each thread keeps a count of its own, and what the file tells is off by hundreds of
    // KiB.
    each_line("/proc/self/smaps_rollup", [&](const char* line) {
        if (std::strncmp(line, "Rss:", 4) == 0)
            held.resident_kib = std::strtol(line + 4, nullptr, 10);
    });
    if (held.resident_kib == 0)
        give_up("/proc/self/smaps_rollup");
    return held;
}

} // namespace dicot
