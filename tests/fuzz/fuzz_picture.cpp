// Any bytes at all through the picture readers.
#include "dicot/picture/read_picture.h"

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

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace dicot;
    const std::span<const std::byte> bytes = std::as_bytes(std::span{data, size});
    const Result<PictureSize> told = picture_size_bytes(bytes, "fuzz");
    if (!told.ok()) {
        require(told.status().fault() == Fault::kBadData || told.status().fault() == Fault::kOsError);
        require(told.status().message()[0] != '\0');
        return 0;
    }
    const PictureSize picture = told.value();
    require(picture.width >= 1 && picture.height >= 1 && picture.width <= kMaxPictureSide &&
            picture.height <= kMaxPictureSide && picture.pixels() <= kMaxPicturePixels);
    constexpr std::int64_t kDecodedPixels = 256 * 1024; // larger ones cost time and show nothing new
    if (picture.pixels() > kDecodedPixels)
        return 0;
    // Exactly as large as told, so that a byte beyond it is seen.
    const auto pixels = std::make_unique<Rgb8[]>(static_cast<std::size_t>(picture.pixels()));
    const Status status = read_picture_bytes(bytes, "fuzz", {pixels.get(), picture.width, picture.height});
    require(status.ok() || status.fault() == Fault::kBadData || status.fault() == Fault::kOsError);
    require(status.ok() || status.message()[0] != '\0');
    return 0;
}
