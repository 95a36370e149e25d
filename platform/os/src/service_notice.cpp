#include "dicot/os/service_notice.h"

#include <cerrno>
#include <charconv>
#include <cinttypes>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <unistd.h>

namespace dicot {
namespace {

/// A number of the environment; 0: it is not there, or none.
std::int64_t number_of(const char* name) noexcept
{
    const char* text = std::getenv(name); // NOLINT(concurrency-mt-unsafe): at the start
    std::int64_t number = 0;
    if (text == nullptr)
        return 0;
    const char* end = text + std::strlen(text);
    const auto [stopped, error] = std::from_chars(text, end, number);
    return error == std::errc{} && stopped == end && number > 0 ? number : 0;
}

} // namespace

ServiceNotice::~ServiceNotice()
{
    if (socket_ >= 0)
        ::close(socket_);
}

Status ServiceNotice::open() noexcept
{
    const char* name = std::getenv("NOTIFY_SOCKET"); // NOLINT(concurrency-mt-unsafe): at the start
    if (name == nullptr || *name == '\0')
        return {};
    const std::size_t length = std::strlen(name);
    if ((*name != '/' && *name != '@') || length < 2 || length >= sizeof address_.sun_path)
        return failure(
            Fault::kConfig,
            "NOTIFY_SOCKET is \"%.40s\": it must be a path or '@' and a name, 107 bytes at most; start dicot "
            "by systemd, or without it",
            name);
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket_ < 0)
        return failure(Fault::kOsError, "no socket to the supervisor (%s)", strerrordesc_np(errno));
    address_.sun_family = AF_UNIX;
    std::memcpy(address_.sun_path, name, length);
    address_bytes_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length);
    if (*name == '@')
        address_.sun_path[0] = '\0'; // abstract: the name has no end but its length
    else
        ++address_bytes_;
    const std::int64_t watched = number_of("WATCHDOG_PID");
    if (watched == 0 || watched == ::getpid())
        most_silence_us_ = number_of("WATCHDOG_USEC");
    return {};
}

void ServiceNotice::send(const char* words) noexcept
{
    if (socket_ >= 0)
        (void)::sendto(socket_, words, std::strlen(words), MSG_NOSIGNAL | MSG_DONTWAIT,
                       reinterpret_cast<const sockaddr*>(&address_), address_bytes_);
}

void ServiceNotice::ready() noexcept
{
    send("READY=1");
}

void ServiceNotice::stopping() noexcept
{
    send("STOPPING=1");
}

void ServiceNotice::alive() noexcept
{
    send("WATCHDOG=1");
}

void ServiceNotice::bear(std::int64_t more_us) noexcept
{
    if (most_silence_us_ <= 0)
        return;
    char words[64];
    std::snprintf(words, sizeof words, "WATCHDOG_USEC=%" PRId64, most_silence_us_ + more_us);
    send(words);
}

void ServiceNotice::status(const char* text) noexcept
{
    char words[256];
    std::snprintf(words, sizeof words, "STATUS=%s", text);
    for (char* c = words; *c != '\0'; ++c)
        if (static_cast<unsigned char>(*c) < 0x20 || *c == 0x7f)
            *c = ' '; // a line end would begin another word of the protocol
    send(words);
}

} // namespace dicot
