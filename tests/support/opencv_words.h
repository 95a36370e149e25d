// Our words in OpenCV's, for tests that let it judge.
#pragma once

#include "dicot/base/stereo_rig.h"

#include <opencv2/core.hpp>

#include <array>
#include <cstddef>

namespace dicot::test {

inline cv::Mat camera_matrix(const Lens& lens)
{
    return (cv::Mat_<double>(3, 3) << lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
}

inline cv::Mat coefficients(const Lens& lens)
{
    return cv::Mat(1, 12, CV_64F, const_cast<double*>(lens.k.data())).clone();
}

inline cv::Mat matrix_of(const Turn& turn)
{
    return cv::Mat(3, 3, CV_64F, const_cast<double*>(turn.data())).clone();
}

inline cv::Mat column_of(const Point3& p)
{
    return (cv::Mat_<double>(3, 1) << p.x, p.y, p.z);
}

inline Turn turn_of(const cv::Mat& m)
{
    Turn turn{};
    for (int i = 0; i < 9; ++i)
        turn[static_cast<std::size_t>(i)] = m.at<double>(i / 3, i % 3);
    return turn;
}

inline Lens lens_of(const cv::Mat& k, const cv::Mat& d)
{
    Lens lens{k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2), k.at<double>(1, 2), {}};
    for (std::size_t i = 0; i < lens.k.size() && i < d.total(); ++i)
        lens.k[i] = d.at<double>(static_cast<int>(i));
    return lens;
}

inline double largest_difference(const cv::Mat& a, const cv::Mat& b)
{
    return cv::norm(a, b, cv::NORM_INF);
}

} // namespace dicot::test
