#include "plug.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace dicot::usbip {

namespace {

constexpr const char* kAttach = "/sys/devices/platform/vhci_hcd.0/attach";
constexpr int kHighSpeed = 3; // USB_SPEED_HIGH of the kernel
constexpr std::size_t kReadBytes = 65536;

Status attach(int port, int socket)
{
    const int file = ::open(kAttach, O_WRONLY | O_CLOEXEC);
    if (file < 0)
        return failure(Fault::kUnavailable, "%s: %s; load the module vhci-hcd, as root", kAttach, std::strerror(errno));
    char line[64];
    const int length = std::snprintf(line, sizeof line, "%d %d %d %d", port, socket, port + 1, kHighSpeed);
    const bool done = ::write(file, line, static_cast<std::size_t>(length)) == length;
    const int error = errno;
    ::close(file);
    if (!done)
        return failure(Fault::kTryAgain, "%s: port %d: %s", kAttach, port, std::strerror(error));
    return {};
}

} // namespace

Status Plug::plug_in(int port)
{
    pull();
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return failure(Fault::kOsError, "no socket pair: %s", std::strerror(errno));
    const Status status = attach(port, ends[1]);
    ::close(ends[1]);
    if (!status.ok()) {
        ::close(ends[0]);
        return status;
    }
    socket_ = ends[0];
    return {};
}

void Plug::pull()
{
    if (socket_ >= 0)
        ::close(socket_);
    socket_ = -1;
    incoming_.clear();
    read_ = 0;
}

bool Plug::receive()
{
    incoming_.erase(incoming_.begin(), incoming_.begin() + static_cast<std::ptrdiff_t>(read_));
    read_ = 0;
    const std::size_t had = incoming_.size();
    incoming_.resize(had + kReadBytes);
    const ssize_t got = ::recv(socket_, incoming_.data() + had, kReadBytes, MSG_DONTWAIT);
    incoming_.resize(had + static_cast<std::size_t>(got > 0 ? got : 0));
    return got > 0 || (got < 0 && (errno == EAGAIN || errno == EINTR));
}

Read Plug::next()
{
    Read read = read_request(std::span(incoming_).subspan(read_));
    read_ += read.consumed;
    return read;
}

bool Plug::send(const Bytes& message)
{
    std::size_t sent = 0;
    while (socket_ >= 0 && sent < message.size()) {
        const ssize_t part = ::send(socket_, message.data() + sent, message.size() - sent, MSG_NOSIGNAL);
        if (part < 0 && errno != EINTR)
            return false;
        sent += static_cast<std::size_t>(part > 0 ? part : 0);
    }
    return socket_ >= 0;
}

} // namespace dicot::usbip
