#include "dicot/os/process_memory.h"

#include "dicot/os/input_file.h"

#include <array>
#include <cstdlib>
#include <cstring>

namespace dicot {
namespace {

/// The number of kB behind "\n<key>:", or 0.
std::uint64_t bytes_behind(const char* text, const char* key) noexcept
{
    const char* found = std::strstr(text, key);
    return found == nullptr ? 0 : std::uint64_t{std::strtoull(found + std::strlen(key), nullptr, 10)} * 1024;
}

} // namespace

Result<ProcessMemory> process_memory() noexcept
{
    InputFile file;
    TRY(file.open("/proc/self/status"));
    std::array<char, 8192> text{};
    TRY(file.read(std::as_writable_bytes(std::span{text}).first(text.size() - 1)));
    const ProcessMemory memory{bytes_behind(text.data(), "\nVmRSS:"), bytes_behind(text.data(), "\nVmHWM:"),
                               bytes_behind(text.data(), "\nVmSize:")};
    if (memory.resident_bytes == 0 || memory.peak_bytes == 0)
        return failure(Fault::kOsError, "/proc/self/status does not tell this process's memory; is /proc mounted?");
    return memory;
}

} // namespace dicot
