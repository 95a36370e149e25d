// Any bytes at all as a frame of any format: one byte of format, two each of width and height, then the frame.
#include "dicot/camera/decode_frame.h"
#include "dicot/camera/luma.h"

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
    if (size < 5)
        return 0;
    const CameraMode mode{static_cast<PixelFormat>(data[0] % 5), data[1] + 256 * data[2] - 8,
                          data[3] + 256 * data[4] - 8, 333333};
    const Frame frame{
        .bytes = std::as_bytes(std::span{data + 5, size - 5}), .mode = mode, .verdict = FrameVerdict::kWhole};
    constexpr std::int64_t kDecodedPixels = 256 * 1024; // larger ones cost time and show nothing new
    const std::int64_t pixels = std::int64_t{mode.width} * mode.height;
    const bool decodes = mode.width > 0 && mode.height > 0 && pixels <= kDecodedPixels;
    // Exactly as large as told, so that a byte beyond it is seen.
    const auto memory = std::make_unique<Rgb8[]>(decodes ? static_cast<std::size_t>(pixels) : 1);
    const Status status = decodes ? decode_frame(frame, {memory.get(), mode.width, mode.height}) : check_frame(frame);
    require(status.ok() || (status.fault() == Fault::kBadData && status.message()[0] != '\0'));
    if (!decodes)
        return 0;
    const Result<LumaFigures> luma = luma_of(frame);
    require(luma.ok() == status.ok());
    if (luma.ok())
        require(luma.value().samples > 0 && luma.value().mean_q8 <= 255U * 256 && luma.value().saturated_q16 <= 65536U);
    return 0;
}
