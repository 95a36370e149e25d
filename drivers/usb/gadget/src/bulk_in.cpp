#include "bulk_in.h"

#include <algorithm>
#include <cerrno>

namespace dicot::gadget_parts {

BulkIn::BulkIn(AioQueue& queue, int descriptor, std::span<std::byte> memory) noexcept
    : queue_(queue), descriptor_(descriptor)
{
    const std::size_t each = memory.size() / kMost;
    for (std::size_t i = 0; i < kMost; ++i)
        buffers_[i].memory = memory.subspan(i * each, each);
}

bool BulkIn::take_next() noexcept
{
    taken_ = taken_ || (!buffers_[next_].transfer.under_way && buffers_[next_].settled);
    return taken_;
}

void BulkIn::submit() noexcept
{
    Buffer& buffer = buffers_[next_];
    buffer.sent = filled_;
    buffer.settled = false;
    queue_.write(buffer.transfer, descriptor_, buffer.memory.first(filled_));
    next_ = (next_ + 1) % kMost;
    filled_ = 0;
    taken_ = false;
}

std::size_t BulkIn::add(std::span<const std::byte> bytes) noexcept
{
    std::size_t added = 0;
    while (added < bytes.size() && take_next()) {
        const std::span<std::byte> room = buffers_[next_].memory.subspan(filled_);
        const std::size_t count = std::min(room.size(), bytes.size() - added);
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(added), count, room.begin());
        added += count;
        filled_ += count;
        if (count == room.size())
            submit();
    }
    return added;
}

bool BulkIn::finish(unsigned packet_bytes) noexcept
{
    if (!empty_due_) {
        const bool whole = filled_ % packet_bytes == 0;
        if (filled_ > 0)
            submit();
        empty_due_ = whole;
    }
    if (!empty_due_)
        return true;
    if (!take_next())
        return false;
    submit();
    empty_due_ = false;
    return true;
}

bool BulkIn::settle() noexcept
{
    bool any = false;
    for (Buffer& buffer : buffers_) {
        if (buffer.settled || buffer.transfer.under_way)
            continue;
        buffer.settled = any = true;
        const std::int64_t result = buffer.transfer.result;
        if (error_ == 0 && result != static_cast<std::int64_t>(buffer.sent))
            error_ = result < 0 ? static_cast<int>(-result) : EIO;
    }
    return any;
}

bool BulkIn::idle() const noexcept
{
    return std::none_of(buffers_.begin(), buffers_.end(), [](const Buffer& each) { return each.transfer.under_way; });
}

void BulkIn::cancel() noexcept
{
    for (std::size_t back = 1; back <= kMost; ++back)
        queue_.cancel(buffers_[(next_ + kMost - back) % kMost].transfer);
}

void BulkIn::forget() noexcept
{
    for (Buffer& buffer : buffers_)
        buffer.settled = true;
    filled_ = 0;
    taken_ = empty_due_ = false;
    error_ = 0;
}

} // namespace dicot::gadget_parts
