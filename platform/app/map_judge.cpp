#include "map_judge.h"

#include <cmath>

namespace dicot::app {
namespace {

bool counts(ImageView<const Rgb8> mask, int x, int y, int k)
{
    return mask.empty() || mask.at(centre_of(x, k), centre_of(y, k)) == Rgb8{255, 255, 255};
}

} // namespace

int multiple_of(int small_width, int small_height, int large_width, int large_height)
{
    const int k = large_width / small_width;
    return k >= 1 && k * small_width == large_width && k * small_height == large_height ? k : 0;
}

MapJudgement judge_map(ImageView<const float> map, ImageView<const float> truth, ImageView<const Rgb8> mask)
{
    const int k = multiple_of(map.width, map.height, truth.width, truth.height);
    const int mask_k = mask.empty() ? 1 : multiple_of(map.width, map.height, mask.width, mask.height);
    MapJudgement found;
    double sum = 0;
    double sum_of_squares = 0;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const double known = truth.at(centre_of(x, k), centre_of(y, k));
            if (!std::isfinite(known) || !counts(mask, x, y, mask_k))
                continue;
            ++found.judged;
            const double error = std::fabs(static_cast<double>(map.at(x, y)) - known / k); // infinite where missing
            for (std::size_t i = 0; i < kBadThresholdsPx.size(); ++i)
                found.bad[i] += error > kBadThresholdsPx[i];
            if (!std::isfinite(error))
                continue;
            for (std::size_t i = 0; i < kBadThresholdsPx.size(); ++i)
                found.wrong[i] += error > kBadThresholdsPx[i];
            ++found.valued;
            sum += error;
            sum_of_squares += error * error;
        }
    }
    if (found.valued > 0) {
        found.mean_error_px = sum / static_cast<double>(found.valued);
        found.rms_error_px = std::sqrt(sum_of_squares / static_cast<double>(found.valued));
    }
    return found;
}

} // namespace dicot::app
