// What comes from the host.
#pragma once

#include "aio_queue.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot::gadget_parts {

/// One buffer that is always at the controller's service while it is empty: so a host that gives up and asks anew is
/// noticed. A transfer of the host ends with a packet that is short, or empty.
class BulkOut
{
public:
    BulkOut(AioQueue& queue, int descriptor, std::span<std::byte> memory) noexcept
        : queue_(queue), descriptor_(descriptor), memory_(memory)
    {
    }

    /// If there is nothing to take, the next read begins.
    void arm() noexcept;
    /// Looks at what has ended, after AioQueue::reap(). Whether something has come just now.
    bool settle() noexcept;
    bool waiting() const noexcept { return full_; } ///< there is something to take
    bool idle() const noexcept { return !transfer_.under_way; }
    int error() const noexcept { return error_; } ///< errno; arm() begins anew

    struct Taken
    {
        std::size_t bytes = 0;
        bool ended = false; ///< the transfer: nothing more belongs to it
    };
    /// Of what is waiting. An empty packet that ends a transfer whose bytes fill `into` exactly comes with the next
    /// call, as nothing: so one read of the same size would see it too.
    Taken take(std::span<std::byte> into) noexcept;

    void cancel() noexcept { queue_.cancel(transfer_); }
    void forget() noexcept; ///< once idle

private:
    AioQueue& queue_;
    int descriptor_;
    std::span<std::byte> memory_;
    Transfer transfer_;
    std::size_t at_ = 0, count_ = 0;
    bool begun_ = false, full_ = false;
    int error_ = 0;
};

} // namespace dicot::gadget_parts
