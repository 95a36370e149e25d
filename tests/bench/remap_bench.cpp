// Our rectification beside OpenCV's, in one run: the same rotations, the same pictures; both results and both times.
#include "rendered_maps.h"

#include "dicot/os/clock.h"
#include "dicot/os/cpu.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace dicot {
namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr int kRounds = 41;

/// Milliseconds of the thread's processor time, the median of rounds in warm memory.
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

/// Broad waves: neighbouring pixels differ by up to 12 grey levels.
std::vector<Rgb8> scene(int seed)
{
    std::vector<Rgb8> pixels(static_cast<std::size_t>(kWidth) * kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto wave = [&](double across, double down) {
                return static_cast<std::uint8_t>(127.5 + 110 * std::sin(across * x + seed) * std::cos(down * y));
            };
            pixels[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)] = {
                wave(0.11, 0.07), wave(0.05, 0.09), wave(0.08, 0.1)};
        }
    return pixels;
}

cv::Mat matrix_of(const Turn& turn)
{
    return cv::Mat(3, 3, CV_64F, const_cast<double*>(turn.data())).clone();
}

/// Fixed-point maps as OpenCV makes them for the same rotations and the same common camera.
void cv_maps(const Lens& lens, const Turn& rectifying, const Rectification& flat, cv::Mat& map, cv::Mat& fraction)
{
    const cv::Mat k = (cv::Mat_<double>(3, 3) << lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
    const cv::Mat d(1, 5, CV_64F, const_cast<double*>(lens.k.data()));
    const cv::Mat p = (cv::Mat_<double>(3, 3) << flat.focal_px, 0, flat.cx_px, 0, flat.focal_px, flat.cy_px, 0, 0, 1);
    cv::initUndistortRectifyMap(k, d, matrix_of(rectifying), p, {kWidth, kHeight}, CV_16SC2, map, fraction);
}

TEST(RemapBench, OpenCvGivesTheSamePictureAndBothTimesArePrinted)
{
    cv::setNumThreads(1);
    const test::RenderedMaps ours;
    std::vector<Rgb8> from[2] = {scene(1), scene(2)};
    std::vector<Rgb8> into[2] = {std::vector<Rgb8>(from[0].size()), std::vector<Rgb8>(from[0].size())};
    cv::Mat map[2], fraction[2], cv_from[2], cv_into[2];
    cv_maps(ours.rig.left, ours.flat.left_rectifying, ours.flat, map[0], fraction[0]);
    cv_maps(ours.rig.right, ours.flat.right_rectifying, ours.flat, map[1], fraction[1]);
    for (int side = 0; side < 2; ++side)
        cv_from[side] = cv::Mat(kHeight, kWidth, CV_8UC3, from[side].data());

    const auto rectify_ours = [&](const Kernels& kernels) {
        for (int side = 0; side < 2; ++side)
            remap(side == 0 ? ours.maps.left : ours.maps.right, kernels,
                  ImageView<const Rgb8>{from[side].data(), kWidth, kHeight},
                  ImageView<Rgb8>{into[side].data(), kWidth, kHeight}, ours.spans);
    };
    const auto rectify_cv = [&] {
        for (int side = 0; side < 2; ++side)
            cv::remap(cv_from[side], cv_into[side], map[side], fraction[side], cv::INTER_LINEAR);
    };
    const Kernels* fastest = &kScalarKernels;
    if (cpu_features().avx2)
        fastest = kernels_for(CpuLevel::kAvx2);
    else if (cpu_features().neon)
        fastest = kernels_for(CpuLevel::kNeon);
    const double scalar_ms = median_ms([&] { rectify_ours(kScalarKernels); });
    const double ours_ms = median_ms([&] { rectify_ours(*fastest); });
    const double cv_ms = median_ms(rectify_cv);

    // OpenCV's positions have 5 fraction bits: 1/64 px off, twice, on slopes of 12 levels a pixel.
    int worst = 0;
    for (int side = 0; side < 2; ++side)
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const Rgb8 a = into[side][static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
                const auto& b = cv_into[side].at<cv::Vec3b>(y, x);
                worst = std::max({worst, std::abs(a.r - b[0]), std::abs(a.g - b[1]), std::abs(a.b - b[2])});
            }
    std::printf("rectify 2 x %d x %d colour, one thread, median of %d | dicot %s %.2f ms | scalar %.2f ms | OpenCV %s, "
                "%d x CV_16SC2 %.2f ms | %.2f x OpenCV's speed | pictures differ by at most %d of 255\n",
                kWidth, kHeight, kRounds, fastest->name, ours_ms, scalar_ms, CV_VERSION, 2, cv_ms, cv_ms / ours_ms,
                worst);
    EXPECT_LE(worst, 2);
}

} // namespace
} // namespace dicot
