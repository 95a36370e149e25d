// What a pair costs on its way from the drivers' buffers to one averaged pair of pictures: processor time and memory.
#include "dicot/camera/decode_frame.h"
#include "dicot/camera_rig/burst.h"
#include "dicot/os/clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace dicot {
namespace {

constexpr int kRounds = 21;
constexpr int kPairs = 8;

/// Milliseconds of processor time, the median of rounds in warm memory.
template <typename Work>
double median_ms(const Work& work)
{
    std::vector<double> ms;
    for (int round = 0; round < kRounds; ++round) {
        const std::int64_t start = process_cpu_us();
        work();
        ms.push_back(static_cast<double>(process_cpu_us() - start) * 1e-3);
    }
    std::ranges::nth_element(ms, ms.begin() + kRounds / 2);
    return ms[kRounds / 2];
}

struct Size
{
    int width, height;
};

class CaptureCost : public testing::TestWithParam<Size>
{
};

TEST_P(CaptureCost, IsDecodingAndAveraging)
{
    const auto [width, height] = GetParam();
    const CameraMode mode{PixelFormat::kYuyv, width, height, 333333};
    std::vector<std::byte> bytes(frame_bytes(mode));
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::byte>(64 + i * 2654435761U % 97);
    Frame frame;
    frame.bytes = bytes;
    frame.mode = mode;
    frame.verdict = FrameVerdict::kWhole;
    std::vector<Rgb8> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const ImageView<Rgb8> picture{pixels.data(), width, height};
    Status decoded;
    const double decode_ms = median_ms([&] { decoded = decode_frame(frame, picture); });
    ASSERT_TRUE(decoded.ok()) << decoded.message();
    const std::vector<Rgb8> alone = pixels;

    Arena measure;
    const FrameAverage measured(measure, width, height);
    Arena whole;
    const Burst burst(whole, width, height, {});
    std::vector<std::byte> block(measure.peak());
    Arena arena{std::span<std::byte>(block)};
    FrameAverage average(arena, width, height);
    const double add_ms = median_ms([&] {
        average.begin();
        for (int k = 0; k < kPairs; ++k)
            average.add(picture);
    });
    const double finish_ms = median_ms([&] { (void)average.finish(picture); });
    std::uint64_t sharpness = 0;
    const double sharp_ms = median_ms([&] { sharpness = sharpness_q8(picture); });
    EXPECT_GT(sharpness, 0U);
    EXPECT_EQ(pixels, alone); // the mean of pictures that are alike
    std::printf("%d x %d YUYV, one thread | a frame: decode %.2f ms, sharpness %.2f ms, average %.2f ms | a burst of "
                "%d pairs: %.1f ms "
                "of processor time | copied before decoding: 0 bytes of %zu | memory of a burst: %.1f MiB\n",
                width, height, decode_ms, sharp_ms, add_ms / kPairs, kPairs,
                2 * (kPairs * (decode_ms + sharp_ms) + add_ms + finish_ms), bytes.size(),
                static_cast<double>(whole.peak()) / (1 << 20));
}
INSTANTIATE_TEST_SUITE_P(Sizes, CaptureCost, testing::Values(Size{640, 480}, Size{1280, 720}));

} // namespace
} // namespace dicot
