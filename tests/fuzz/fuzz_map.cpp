// Any bytes at all through the disparity map readers.
#include "dicot/picture/read_map.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

namespace {

void require(bool promise)
{
    if (!promise)
        std::abort();
}

void require_named(const dicot::Status& status)
{
    require(status.fault() == dicot::Fault::kBadData || status.fault() == dicot::Fault::kOsError);
    require(status.message()[0] != '\0');
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot;
    const std::span<const std::byte> bytes = std::as_bytes(std::span{data, size});
    const Result<MapHead> told = map_head_bytes(bytes, "fuzz");
    if (!told.ok()) {
        require_named(told.status());
        return 0;
    }
    const PictureSize map = told.value().size;
    require(map.width >= 1 && map.height >= 1 && map.width <= kMaxPictureSide && map.height <= kMaxPictureSide &&
            map.pixels() <= kMaxPicturePixels);
    constexpr std::int64_t kDecodedPixels = 256 * 1024; // larger ones cost time and show nothing new
    if (map.pixels() > kDecodedPixels)
        return 0;
    // Exactly as large as told, so that a byte beyond it is seen.
    const auto values = std::make_unique<float[]>(static_cast<std::size_t>(map.pixels()));
    const Status status = read_map_bytes(bytes, "fuzz", 256, {values.get(), map.width, map.height});
    if (!status.ok()) {
        require_named(status);
        return 0;
    }
    for (std::int64_t i = 0; i < map.pixels(); ++i)
        require(std::isfinite(values[static_cast<std::size_t>(i)]) || values[static_cast<std::size_t>(i)] > 0);
    return 0;
}
