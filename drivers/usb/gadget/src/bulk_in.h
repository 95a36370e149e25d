// What is on its way to the host.
#pragma once

#include "aio_queue.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot::gadget_parts {

/// Parts of any size become whole buffers: only the last one of a transfer may end within a packet, whatever the packets'
/// size is at this speed. Buffers go one after the other, several of them at once.
class BulkIn
{
public:
    static constexpr std::size_t kMost = 8;

    BulkIn(AioQueue& queue, int descriptor, std::span<std::byte> memory) noexcept; ///< kMost equal buffers

    /// As many bytes as there is room for now; 0: wait().
    std::size_t add(std::span<const std::byte> bytes) noexcept;
    /// The transfer ends here, with a short packet or an empty one. False: no room now, call again.
    bool finish(unsigned packet_bytes) noexcept;

    /// Looks at what has ended, after AioQueue::reap(). Whether something has.
    bool settle() noexcept;
    int error() const noexcept { return error_; } ///< errno of the first that failed; 0: none
    bool idle() const noexcept;
    /// Asks that all ends, the newest first: so no gap can follow what the host still takes.
    void cancel() noexcept;
    void forget() noexcept; ///< once idle: nothing is begun, nothing has failed

private:
    struct Buffer
    {
        Transfer transfer;
        std::span<std::byte> memory;
        std::size_t sent = 0;
        bool settled = true;
    };
    bool take_next() noexcept;
    void submit() noexcept;

    AioQueue& queue_;
    int descriptor_;
    std::array<Buffer, kMost> buffers_;
    std::size_t next_ = 0;   ///< which one is filled now, or next
    std::size_t filled_ = 0; ///< bytes of it
    bool taken_ = false;     ///< it is ours to fill
    bool empty_due_ = false; ///< all but the empty packet has gone
    int error_ = 0;
};

} // namespace dicot::gadget_parts
