#include "bulk_in.h"

#include <algorithm>
#include <cerrno>

namespace dicot::gadget_parts {

bool BulkIn::Part::over() const noexcept
{
    return std::none_of(chunks.begin(), chunks.end(),
                        [](const Chunk& each) { return each.transfer.under_way || !each.settled; });
}

bool BulkIn::has_room() const noexcept
{
    return parts_[next_].over();
}

void BulkIn::submit(Part& part, std::span<const std::byte> bytes) noexcept
{
    Chunk& chunk = part.chunks[part.count++];
    chunk.bytes = bytes.size();
    chunk.settled = false;
    queue_.write(chunk.transfer, descriptor_, bytes);
}

void BulkIn::send(std::span<const std::byte> bytes, bool last, unsigned packet_bytes) noexcept
{
    Part& part = parts_[next_];
    next_ = (next_ + 1) % kParts;
    part.count = 0;
    const bool whole = bytes.size() % packet_bytes == 0;
    while (!bytes.empty()) {
        const std::size_t count = std::min(bytes.size(), kChunkBytes);
        submit(part, bytes.first(count));
        bytes = bytes.subspan(count);
    }
    if (last && whole)
        submit(part, bytes);
}

bool BulkIn::settle() noexcept
{
    bool any = false;
    for (Part& part : parts_)
        for (Chunk& chunk : part.chunks) {
            if (chunk.settled || chunk.transfer.under_way)
                continue;
            chunk.settled = any = true;
            const std::int64_t result = chunk.transfer.result;
            if (error_ == 0 && result != static_cast<std::int64_t>(chunk.bytes))
                error_ = result < 0 ? static_cast<int>(-result) : EIO;
        }
    return any;
}

bool BulkIn::idle() const noexcept
{
    return std::all_of(parts_.begin(), parts_.end(), [](const Part& each) { return each.over(); });
}

void BulkIn::cancel() noexcept
{
    for (std::size_t back = 1; back <= kParts; ++back) {
        Part& part = parts_[(next_ + kParts - back) % kParts];
        for (std::size_t i = part.count; i-- > 0;)
            queue_.cancel(part.chunks[i].transfer);
    }
}

void BulkIn::forget() noexcept
{
    for (Part& part : parts_)
        part.count = 0;
    error_ = 0;
}

} // namespace dicot::gadget_parts
