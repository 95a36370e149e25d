// The kernel's asynchronous reads and writes (io_submit(2)), without its library: each ends on one eventfd.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/base/status.h"

#include <cstddef>
#include <cstdint>
#include <linux/aio_abi.h>
#include <span>

namespace dicot::gadget_parts {

/// One read or write; stays where it is while under way.
struct Transfer
{
    iocb block{};
    bool under_way = false;
    std::int64_t result = 0; ///< of the last one: bytes, or a negative errno
};

/// From one thread. Fault::kOsError where the kernel has no AIO.
class AioQueue
{
public:
    AioQueue() noexcept = default;
    AioQueue(const AioQueue&) = delete;
    AioQueue& operator=(const AioQueue&) = delete;
    /// Ends what is under way, and waits for it.
    ~AioQueue();

    Status open(unsigned most) noexcept;
    int ready() const noexcept { return event_; } ///< readable when something has ended

    /// The memory must stay until the transfer has ended. A refusal ends it at once: `result`.
    void read(Transfer& transfer, int descriptor, std::span<std::byte> into) noexcept;
    void write(Transfer& transfer, int descriptor, std::span<const std::byte> from) noexcept;
    /// What has ended so far, each with its result. Never waits. How many.
    int reap() noexcept;
    /// Asks the kernel to end it; it ends with what was transferred, or -ECONNRESET.
    void cancel(Transfer& transfer) noexcept;

private:
    void submit(Transfer& transfer) noexcept;

    aio_context_t context_ = 0;
    int event_ = -1;
};

} // namespace dicot::gadget_parts
