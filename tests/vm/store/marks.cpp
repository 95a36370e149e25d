#include "marks.h"

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace dicot {

Result<Marks> Marks::open(const char* device, std::int64_t first)
{
    const int descriptor = ::open(device, O_WRONLY | O_DIRECT | O_CLOEXEC);
    if (descriptor < 0)
        return failure(Fault::kUnavailable, "%s: no place for marks: %s", device, std::strerror(errno));
    return Marks{descriptor, first};
}

Marks::Marks(Marks&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)), next_(other.next_) {}

Marks::~Marks()
{
    if (descriptor_ >= 0)
        ::close(descriptor_);
}

Status Marks::put(const char* format, ...)
{
    alignas(4096) static char sector[kSectorBytes]; // what is written around the cache must be aligned
    std::memset(sector, 0, sizeof sector);
    int length = std::snprintf(sector, sizeof sector, "dicot mark\n");
    va_list arguments;
    va_start(arguments, format);
    length += std::vsnprintf(sector + length, sizeof sector - static_cast<std::size_t>(length), format, arguments);
    va_end(arguments);
    if (length + 1 >= kSectorBytes)
        return failure(Fault::kSoftware, "a mark is too long");
    sector[length] = '\n';
    if (::pwrite(descriptor_, sector, sizeof sector, next_) != kSectorBytes)
        return failure(Fault::kIoError, "a mark cannot be written: %s", std::strerror(errno));
    next_ += kSectorBytes;
    return {};
}

} // namespace dicot
