#include "sparsification.h"

#include <algorithm>
#include <array>

namespace dicot::test {
namespace {

constexpr std::size_t kCurvePoints = 10;

/// means[k] is the mean of the first k + 1 pixels.
double area_under(const std::vector<double>& means)
{
    double sum = 0;
    for (const double mean : means)
        sum += mean;
    return sum / static_cast<double>(means.size());
}

std::vector<double> points_of(const std::vector<double>& means)
{
    std::vector<double> curve;
    for (std::size_t i = 0; i < kCurvePoints; ++i)
        curve.push_back(means[means.size() * (kCurvePoints - i) / kCurvePoints - 1]);
    return curve;
}

} // namespace

Sparsification sparsified(std::vector<Judged> pixels)
{
    if (pixels.empty())
        return {};
    struct Level
    {
        std::size_t count = 0;
        double wrong = 0;
    };
    std::array<Level, 256> levels{};
    for (const Judged& pixel : pixels) {
        ++levels[pixel.confidence].count;
        levels[pixel.confidence].wrong += static_cast<double>(pixel.wrong);
    }
    std::vector<double> means;
    means.reserve(pixels.size());
    double sum = 0;
    for (auto level = levels.rbegin(); level != levels.rend(); ++level)
        for (std::size_t i = 0; i < level->count; ++i) {
            sum += level->wrong / static_cast<double>(level->count);
            means.push_back(sum / static_cast<double>(means.size() + 1));
        }
    Sparsification made;
    made.area = area_under(means);
    made.curve = points_of(means);
    made.blind = means.back();

    std::ranges::sort(pixels, {}, &Judged::wrong);
    sum = 0;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        sum += static_cast<double>(pixels[k].wrong);
        means[k] = sum / static_cast<double>(k + 1);
    }
    made.ideal = area_under(means);
    made.ideal_curve = points_of(means);
    return made;
}

} // namespace dicot::test
