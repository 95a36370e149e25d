// The cable: a socket pair whose other end the kernel's virtual host controller holds.
#pragma once

#include "dicot/base/status.h"

#include "wire.h"

#include <optional>

namespace dicot::usbip {

class Plug
{
public:
    Plug() = default;
    Plug(const Plug&) = delete;
    Plug& operator=(const Plug&) = delete;
    ~Plug() { pull(); }

    /// Plugs a high-speed device into `port` (0 ..) of the first controller.
    ///
    /// Fault::kUnavailable: the module vhci-hcd is not loaded. Fault::kTryAgain: the port is taken, or has not
    /// recovered from the last unplugging yet.
    Status plug_in(int port);
    /// Takes one end of a socket pair instead; for tests.
    void plug_into(int socket) { socket_ = socket; }
    void pull();

    bool is_in() const { return socket_ >= 0; }
    int socket() const { return socket_; }
    /// Reads what is there; false: the host has let go.
    bool receive();
    /// The next whole message.
    Read next();
    /// Blocks until the host has taken it; false: the host has let go.
    bool send(const Bytes& message);

private:
    int socket_ = -1;
    Bytes incoming_;
    std::size_t read_ = 0;
};

} // namespace dicot::usbip
