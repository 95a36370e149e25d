#include "byte_source.h"

#include <algorithm>
#include <cstring>

namespace dicot {

void ByteSource::refill() noexcept
{
    if (file_ == nullptr || !trouble_.ok())
        return;
    const Result<std::size_t> got = file_->read(buffer_);
    if (got.ok())
        ahead_ = std::span<const std::byte>{buffer_}.first(got.value());
    else
        trouble_ = got.status();
}

bool ByteSource::read(std::span<std::byte> into) noexcept
{
    while (!into.empty()) {
        const std::size_t count = std::min(ahead().size(), into.size());
        if (count == 0)
            return false;
        std::memcpy(into.data(), ahead_.data(), count);
        pass(count);
        into = into.subspan(count);
    }
    return true;
}

} // namespace dicot
