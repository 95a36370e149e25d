// Any bytes at all through the cloud reader.
#include "dicot/codec/decode_cloud.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace {

void require(bool promise)
{
    if (!promise)
        std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot;
    const auto bytes = std::as_bytes(std::span{data, size});
    const Result<CloudOutline> outline = outline_of(bytes, "fuzz");
    if (!outline.ok()) {
        require(outline.status().fault() == Fault::kBadData && outline.status().message()[0] != '\0');
        return 0;
    }
    require(outline.value().points >= 1 && outline.value().points <= kMaxCloudPoints);
    constexpr std::size_t kDecodedPoints = 64 * 1024; // larger ones cost time and show nothing new
    if (outline.value().points > kDecodedPoints)
        return 0;
    std::vector<CloudPoint> points(outline.value().points);
    const Status status = decode_cloud(bytes, outline.value(), "fuzz", {}, points);
    if (!status.ok()) {
        require(status.fault() == Fault::kBadData);
        return 0;
    }
    const CloudGrid& grid = outline.value().grid;
    for (const CloudPoint& point : points) {
        const std::int32_t at[3] = {point.x, point.y, point.z};
        for (int axis = 0; axis < 3; ++axis) {
            const std::int64_t index = std::int64_t{at[axis]} - grid.origin[axis];
            require(index >= 0 && index < std::int64_t{1} << grid.bits);
        }
    }
    return 0;
}
