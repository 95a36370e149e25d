#include "bulk_out.h"

#include <algorithm>

namespace dicot::gadget_parts {

void BulkOut::arm() noexcept
{
    if (begun_ || full_)
        return;
    begun_ = true;
    error_ = 0;
    queue_.read(transfer_, descriptor_, memory_);
}

bool BulkOut::settle() noexcept
{
    if (!begun_ || transfer_.under_way)
        return false;
    begun_ = false;
    if (transfer_.result < 0) {
        error_ = static_cast<int>(-transfer_.result);
        return false;
    }
    at_ = 0;
    count_ = static_cast<std::size_t>(transfer_.result);
    full_ = true;
    return true;
}

BulkOut::Taken BulkOut::take(std::span<std::byte> into) noexcept
{
    const bool ends = count_ < memory_.size();
    Taken taken;
    taken.bytes = std::min(into.size(), count_ - at_);
    std::copy_n(memory_.begin() + static_cast<std::ptrdiff_t>(at_), taken.bytes, into.begin());
    at_ += taken.bytes;
    if (at_ < count_)
        return taken;
    // Bytes that fill `into` and end with the buffer's own transfer: a short packet would not be a multiple of 512.
    const bool end_is_empty_packet = ends && taken.bytes > 0 && taken.bytes == into.size();
    if (end_is_empty_packet)
        return taken;
    full_ = false;
    taken.ended = ends;
    return taken;
}

void BulkOut::forget() noexcept
{
    begun_ = full_ = false;
    at_ = count_ = 0;
    error_ = 0;
}

} // namespace dicot::gadget_parts
