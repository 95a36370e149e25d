// What a service tells its supervisor: sd_notify(3)'s protocol, without its library.
#pragma once

#include "dicot/base/status.h"

#include <cstdint>
#include <sys/socket.h>
#include <sys/un.h>

namespace dicot {

/// Datagrams to the socket that NOTIFY_SOCKET names; a name that begins with '@' is of the abstract kind. Without a
/// supervisor every call does nothing. A datagram that does not get through is dropped: a supervisor that hears nothing
/// acts by itself. No heap; any thread.
class ServiceNotice
{
public:
    ServiceNotice() noexcept = default;
    ServiceNotice(const ServiceNotice&) = delete;
    ServiceNotice& operator=(const ServiceNotice&) = delete;
    ~ServiceNotice();

    /// Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID from the environment, once, at the start. Fault::kConfig: a
    /// name that no socket can have. Fault::kOsError: no socket.
    Status open() noexcept;

    bool connected() const noexcept { return socket_ >= 0; }
    /// How long the supervisor bears silence; 0: it does not watch.
    std::int64_t most_silence_us() const noexcept { return most_silence_us_; }

    void ready() noexcept;
    void stopping() noexcept;
    void alive() noexcept;
    /// It bears so much more silence from now on; 0: as at the start. Nothing if it does not watch.
    void bear(std::int64_t more_us) noexcept;
    void status(const char* text) noexcept; ///< one line; control characters are sent as blanks

private:
    void send(const char* words) noexcept;

    int socket_ = -1;
    socklen_t address_bytes_ = 0;
    std::int64_t most_silence_us_ = 0;
    sockaddr_un address_{};
};

} // namespace dicot
