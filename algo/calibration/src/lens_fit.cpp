#include "lens_fit.h"

#include "closed_form.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dicot::calibration {

namespace {

constexpr double kRoughLoss_px = 2;
constexpr double kLeastDeviation_px = 0.01;
constexpr double kLossDeviations = 3;
constexpr int kMaxIterations = 60;

double rms_of(const std::vector<Eigen::Vector2d>& residuals)
{
    double sum = 0;
    for (const Eigen::Vector2d& r : residuals)
        sum += r.squaredNorm();
    return residuals.empty() ? 0 : std::sqrt(sum / static_cast<double>(residuals.size()));
}

double widest_tilt_deg(const std::vector<Pose>& poses, std::span<const Sight> sights)
{
    double least_cosine = 1;
    for (std::size_t p = 0; p < poses.size(); ++p)
        for (std::size_t q = 0; q < p; ++q)
            if (!sights[p].corners.empty() && !sights[q].corners.empty())
                least_cosine =
                    std::min(least_cosine,
                             (poses[p].turn * Eigen::Vector3d::UnitZ()).dot(poses[q].turn * Eigen::Vector3d::UnitZ()));
    return degrees_of_cosine(least_cosine);
}

} // namespace

double median(std::vector<double> values)
{
    if (values.empty())
        return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double robust_deviation(std::vector<double> values)
{
    for (double& v : values)
        v = std::abs(v);
    return 1.4826 * median(std::move(values));
}

double degrees_of_cosine(double cosine)
{
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

LensFit fit_lens(std::span<const Sight> sights, int width, int height, bool fit_k3)
{
    std::vector<Eigen::Matrix3d> homographies;
    for (const Sight& sight : sights)
        if (!sight.corners.empty())
            homographies.push_back(board_homography(*sight.board, sight.corners));

    Bundle bundle;
    bundle.lens[0] = lens_from_homographies(homographies, width, height);
    bundle.lens[1] = bundle.lens[0];
    std::size_t next = 0;
    for (const Sight& sight : sights) {
        BundleView view{sight.board, sight.corners, {}, {}, !sight.corners.empty()};
        if (view.used)
            view.pose = pose_from_homography(bundle.lens[0], homographies[next++]);
        bundle.views.push_back(view);
    }

    // The centre and the fine distortion wander when the rest is far off, so they join later.
    bundle.loss = Loss::kHuber;
    bundle.loss_scale_px = kRoughLoss_px;
    for (const int k : {0, 1, 4})
        bundle.fitted[static_cast<std::size_t>(k)] = true;
    minimise(bundle, kMaxIterations / 2);
    std::fill_n(bundle.fitted.begin(), fit_k3 ? 9 : 8, true);
    minimise(bundle, kMaxIterations);

    std::vector<double> coordinates;
    for (const BundleView& view : bundle.views)
        for (const Eigen::Vector2d& r : residuals(bundle, view, false)) {
            coordinates.push_back(r.x());
            coordinates.push_back(r.y());
        }
    const double deviation_px = std::max(robust_deviation(std::move(coordinates)), kLeastDeviation_px);
    bundle.loss_scale_px = kLossDeviations * deviation_px;
    minimise(bundle, kMaxIterations);

    LensFit fit;
    fit.lens = bundle.lens[0];
    std::vector<double> seen_rms;
    for (const BundleView& view : bundle.views) {
        fit.poses.push_back(view.pose);
        fit.rms_px.push_back(rms_of(residuals(bundle, view, false)));
        if (view.used)
            seen_rms.push_back(fit.rms_px.back());
    }
    fit.median_rms_px = median(std::move(seen_rms));
    const SharedMatrix inverse = inverse_curvature(bundle);
    for (const int k : {0, 1})
        fit.focal_deviation = std::max(fit.focal_deviation, deviation_px * std::sqrt(inverse(k, k)) / fit.lens[k]);
    fit.tilt_spread_deg = widest_tilt_deg(fit.poses, sights);
    return fit;
}

} // namespace dicot::calibration
