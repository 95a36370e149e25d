#include "dicot/os/small_file.h"

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace dicot {

std::optional<ShortText<255>> read_line(const char* path) noexcept
{
    const int descriptor = ::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0)
        return std::nullopt;
    char bytes[256];
    ssize_t count = -1;
    do
        count = ::read(descriptor, bytes, sizeof bytes);
    while (count < 0 && errno == EINTR);
    ::close(descriptor);
    if (count < 0)
        return std::nullopt;
    const std::string_view text{bytes, static_cast<std::size_t>(count)};
    return ShortText<255>{text.substr(0, text.find('\n'))};
}

int write_line(const char* path, const char* text) noexcept
{
    const int descriptor = ::open(path, O_WRONLY | O_TRUNC | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0)
        return errno;
    const std::size_t count = std::strlen(text);
    const ssize_t written = ::write(descriptor, text, count);
    const int error = written < 0 ? errno : static_cast<std::size_t>(written) != count ? EIO : 0;
    return ::close(descriptor) != 0 && error == 0 ? errno : error;
}

JoinedPath::JoinedPath(const char* format, ...) noexcept
{
    va_list arguments;
    va_start(arguments, format);
    const int length = std::vsnprintf(bytes_, sizeof bytes_, format, arguments);
    va_end(arguments);
    if (length < 0 || static_cast<std::size_t>(length) >= sizeof bytes_)
        bytes_[0] = '\0';
}

} // namespace dicot
