// What is on its way to the host.
#pragma once

#include "aio_queue.h"

#include <array>
#include <cstddef>
#include <span>

namespace dicot::gadget_parts {

/// Two parts at once, in chunks that the kernel takes in one piece of memory each; the parts' own memory is lent to it.
class BulkIn
{
public:
    static constexpr std::size_t kParts = 2;
    static constexpr std::size_t kChunkBytes = 32768; ///< larger ones a kernel with little memory may refuse
    static constexpr std::size_t kChunks = 8;         ///< of one part
    static constexpr std::size_t kMostUnderWay = kParts * (kChunks + 1);

    BulkIn(AioQueue& queue, int descriptor) noexcept : queue_(queue), descriptor_(descriptor) {}

    bool has_room() const noexcept; ///< for one part more
    /// `last`: a short packet ends the transfer, or one of none. Else `bytes` must be whole packets.
    void send(std::span<const std::byte> bytes, bool last, unsigned packet_bytes) noexcept;

    /// Looks at what has ended, after AioQueue::reap(). Whether something has.
    bool settle() noexcept;
    int error() const noexcept { return error_; } ///< errno of the first that failed; 0: none
    bool idle() const noexcept;
    /// Asks that all ends, the newest first: so no gap can follow what the host still takes.
    void cancel() noexcept;
    void forget() noexcept; ///< once idle: nothing has failed

private:
    struct Chunk
    {
        Transfer transfer;
        std::size_t bytes = 0;
        bool settled = true;
    };
    struct Part
    {
        std::array<Chunk, kChunks + 1> chunks; ///< the last one for the packet of none
        std::size_t count = 0;

        bool over() const noexcept;
    };
    void submit(Part& part, std::span<const std::byte> bytes) noexcept;

    AioQueue& queue_;
    int descriptor_;
    std::array<Part, kParts> parts_;
    std::size_t next_ = 0;
    int error_ = 0;
};

} // namespace dicot::gadget_parts
