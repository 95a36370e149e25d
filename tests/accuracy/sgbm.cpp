#include "sgbm.h"

#include <opencv2/calib3d.hpp>

#include <limits>

namespace dicot::test {
namespace {

cv::Mat as_mat(const scenes::Picture& picture)
{
    return {picture.height, picture.width, CV_8UC3, const_cast<Rgb8*>(picture.pixels.data())};
}

} // namespace

Disparities sgbm_hh(const scenes::Picture& left, const scenes::Picture& right, const DisparityRange& range)
{
    constexpr int kBlock = 5, kLeap = 32 * 3 * kBlock * kBlock, kStep = 8 * 3 * kBlock * kBlock;
    constexpr int kMostApart = 1, kUniqueness = 10, kSpeckle = 100, kSpeckleRange = 2, kFraction = 16;
    const int wide = (range.disparities + 15) / 16 * 16;
    const auto matcher = cv::StereoSGBM::create(range.min_disparity, wide, kBlock, kStep, kLeap, kMostApart, 0,
                                                kUniqueness, kSpeckle, kSpeckleRange, cv::StereoSGBM::MODE_HH);
    cv::Mat found;
    matcher->compute(as_mat(left), as_mat(right), found);
    Disparities made{left.width, left.height, {}, {}};
    for (int y = 0; y < left.height; ++y)
        for (int x = 0; x < left.width; ++x) {
            const int value = found.at<short>(y, x);
            made.px.push_back(value < kFraction * range.min_disparity ? std::numeric_limits<float>::quiet_NaN()
                                                                      : static_cast<float>(value) / kFraction);
        }
    return made;
}

} // namespace dicot::test
