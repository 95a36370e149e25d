#include "opencv_eyes.h"

#include "opencv_words.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace dicot::test {
namespace {

std::vector<cv::Point2f> floats_of(const std::vector<Point2>& corners)
{
    std::vector<cv::Point2f> floats;
    for (const Point2& corner : corners)
        floats.emplace_back(static_cast<float>(corner.x), static_cast<float>(corner.y));
    return floats;
}

std::vector<cv::Point3f> points_of(const Board& board)
{
    std::vector<cv::Point3f> points;
    for (int row = 0; row < board.rows; ++row)
        for (int col = 0; col < board.cols; ++col)
            points.emplace_back(static_cast<float>(col * board.square_mm), static_cast<float>(row * board.square_mm),
                                0.0F);
    return points;
}

} // namespace

std::vector<Point2> corners_by_opencv(OpenCvEyes eyes, GreyPicture& picture, const Board& board)
{
    const cv::Mat grey(picture.height, picture.width, CV_8U, picture.pixels.data());
    const cv::Size size(board.cols, board.rows);
    std::vector<cv::Point2f> found;
    if (eyes == OpenCvEyes::kSectors) {
        if (!cv::findChessboardCornersSB(grey, size, found, cv::CALIB_CB_ACCURACY))
            return {};
    } else {
        if (!cv::findChessboardCorners(grey, size, found,
                                       cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE |
                                           cv::CALIB_CB_FAST_CHECK))
            return {};
        cv::cornerSubPix(grey, found, {5, 5}, {-1, -1}, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-3});
    }
    std::vector<Point2> corners;
    for (const cv::Point2f& corner : found)
        corners.push_back({static_cast<double>(corner.x), static_cast<double>(corner.y)});
    return corners;
}

Solved solved_by_opencv(const CalibrationTask& task)
{
    std::vector<std::vector<cv::Point3f>> points;
    std::vector<std::vector<cv::Point2f>> left, right;
    for (const calibration::View& view : task.views) {
        points.push_back(points_of(task.boards[static_cast<std::size_t>(view.board)]));
        left.push_back(floats_of(view.left));
        right.push_back(floats_of(view.right));
    }
    const cv::Size size(task.width, task.height);
    const cv::TermCriteria patient(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-9);
    cv::Mat k1, d1, k2, d2, turn, shift, essential, fundamental;
    cv::calibrateCamera(points, left, size, k1, d1, cv::noArray(), cv::noArray(), cv::CALIB_FIX_K3, patient);
    cv::calibrateCamera(points, right, size, k2, d2, cv::noArray(), cv::noArray(), cv::CALIB_FIX_K3, patient);
    Solved solved;
    solved.rms_px = cv::stereoCalibrate(points, left, right, k1, d1, k2, d2, size, turn, shift, essential, fundamental,
                                        cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_K3, patient);
    solved.rig = {task.width,      task.height,   lens_of(k1, d1),
                  lens_of(k2, d2), turn_of(turn), {shift.at<double>(0), shift.at<double>(1), shift.at<double>(2)}};
    return solved;
}

} // namespace dicot::test
