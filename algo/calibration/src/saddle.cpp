#include "saddle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dicot::calibration {

double length(Point2 p)
{
    return std::sqrt(dot(p, p));
}

Point2 unit(Point2 p)
{
    const double size = length(p);
    return size > 0 ? (1.0 / size) * p : Point2{1, 0};
}

namespace {

constexpr int kRing = 32;
constexpr double kMinContrast = 8;    // grey levels; sensor noise after smoothing is below 2
constexpr float kMinResponse = 0.6F;  // a crossing of 8 grey levels at the smoothing used
constexpr double kMinOpposite = 0.80; // cosine between an edge and its continuation
constexpr double kMinOpening = 0.17;  // sine of the angle between the two edges
constexpr double kMaxOddShare = 0.35; // energy that a half turn around the crossing does not preserve
constexpr std::array<double, 2> kRadii_px{5.0, 3.2};

std::array<Point2, kRing> ring_directions()
{
    const double cos_eighth = std::sqrt(0.5);
    const double cos_16th = std::sqrt((1 + cos_eighth) / 2);
    const double cos_step = std::sqrt((1 + cos_16th) / 2);
    const double sin_step = std::sqrt((1 - cos_16th) / 2);
    std::array<Point2, kRing> ring{};
    ring[0] = {1, 0};
    for (std::size_t k = 1; k < kRing; ++k)
        ring[k] = {ring[k - 1].x * cos_step - ring[k - 1].y * sin_step,
                   ring[k - 1].x * sin_step + ring[k - 1].y * cos_step};
    return ring;
}

struct Peak
{
    float response;
    int x;
    int y;
};

/// The Hessian's negative determinant, which only crossings (and not edges or blobs) make large; its local maxima.
std::vector<Peak> find_peaks(const GreyLevel& level)
{
    const int w = level.width;
    const int h = level.height;
    GreyLevel response{w, h, std::vector<float>(level.pixels.size(), 0.0F)};
    for (int y = 1; y < h - 1; ++y) {
        const float* const up = &level.pixels[static_cast<std::size_t>(y - 1) * static_cast<std::size_t>(w)];
        const float* const mid = up + w;
        const float* const down = mid + w;
        float* const out = &response.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(w)];
        for (int x = 1; x < w - 1; ++x) {
            const float xx = mid[x - 1] + mid[x + 1] - 2 * mid[x];
            const float yy = up[x] + down[x] - 2 * mid[x];
            const float xy = 0.25F * (down[x + 1] - down[x - 1] - up[x + 1] + up[x - 1]);
            out[x] = xy * xy - xx * yy;
        }
    }
    std::vector<Peak> peaks;
    constexpr int kReach = 2;
    for (int y = kReach; y < h - kReach; ++y) {
        for (int x = kReach; x < w - kReach; ++x) {
            const float here = response.at(x, y);
            if (here < kMinResponse)
                continue;
            bool highest = true;
            for (int dy = -kReach; dy <= kReach && highest; ++dy)
                for (int dx = -kReach; dx <= kReach && highest; ++dx) {
                    const float other = response.at(x + dx, y + dy);
                    const bool earlier = dy < 0 || (dy == 0 && dx < 0);
                    highest = earlier ? here > other : here >= other;
                }
            if (highest)
                peaks.push_back({here, x, y});
        }
    }
    std::stable_sort(peaks.begin(), peaks.end(), [](const Peak& p, const Peak& q) { return p.response > q.response; });
    return peaks;
}

/// Where the parabola through the 3 x 3 neighbours is level.
Point2 level_point(const GreyLevel& level, int x, int y)
{
    const double dx = 0.5 * (level.at(x + 1, y) - level.at(x - 1, y));
    const double dy = 0.5 * (level.at(x, y + 1) - level.at(x, y - 1));
    const double xx = level.at(x + 1, y) + level.at(x - 1, y) - 2.0 * level.at(x, y);
    const double yy = level.at(x, y + 1) + level.at(x, y - 1) - 2.0 * level.at(x, y);
    const double xy =
        0.25 * (level.at(x + 1, y + 1) - level.at(x - 1, y + 1) - level.at(x + 1, y - 1) + level.at(x - 1, y - 1));
    const double determinant = xx * yy - xy * xy;
    const double step_x = -(yy * dx - xy * dy) / determinant;
    const double step_y = -(xx * dy - xy * dx) / determinant;
    return {x + std::clamp(step_x, -1.0, 1.0), y + std::clamp(step_y, -1.0, 1.0)};
}

} // namespace

std::optional<Saddle> read_saddle(const GreyLevel& level, Point2 at, double radius_px, double min_contrast)
{
    static const std::array<Point2, kRing> ring = ring_directions();
    if (!level.contains(at.x, at.y, 1.0))
        return std::nullopt;

    std::array<double, kRing> value{};
    for (std::size_t k = 0; k < kRing; ++k)
        value[k] = level.sample(at.x + radius_px * ring[k].x, at.y + radius_px * ring[k].y);
    const auto [low, high] = std::minmax_element(value.begin(), value.end());
    const double contrast = *high - *low;
    if (contrast < min_contrast)
        return std::nullopt;

    double mean = 0;
    for (const double v : value)
        mean += v / kRing;
    double odd = 0;
    double even = 0;
    for (std::size_t k = 0; k < kRing / 2; ++k) {
        const double half_turn = value[k + kRing / 2];
        odd += (value[k] - half_turn) * (value[k] - half_turn);
        even += (value[k] + half_turn - 2 * mean) * (value[k] + half_turn - 2 * mean);
    }
    if (odd > kMaxOddShare * even)
        return std::nullopt;

    const double middle = 0.5 * (*high + *low);
    std::array<Point2, 4> edge{};
    std::size_t crossings = 0;
    std::size_t rising = 0;
    for (std::size_t k = 0; k < kRing; ++k) {
        const std::size_t next = (k + 1) % kRing;
        if ((value[k] > middle) == (value[next] > middle))
            continue;
        if (crossings == 4)
            return std::nullopt;
        if (value[next] > middle)
            rising = crossings;
        const double share = (middle - value[k]) / (value[next] - value[k]);
        edge[crossings++] = unit(ring[k] + share * (ring[next] - ring[k]));
    }
    if (crossings != 4 || dot(edge[0], edge[2]) > -kMinOpposite || dot(edge[1], edge[3]) > -kMinOpposite)
        return std::nullopt;

    const Point2 a = unit(edge[rising] - edge[(rising + 2) % 4]);
    const Point2 b = unit(edge[(rising + 1) % 4] - edge[(rising + 3) % 4]);
    if (cross(a, b) < kMinOpening)
        return std::nullopt;
    return Saddle{at, a, b, contrast};
}

std::vector<Saddle> find_saddles(const GreyLevel& level, std::size_t most)
{
    std::vector<Saddle> saddles;
    if (level.width < 8 || level.height < 8)
        return saddles;
    for (const Peak& peak : find_peaks(level)) {
        const Point2 at = level_point(level, peak.x, peak.y);
        for (const double radius_px : kRadii_px) {
            const std::optional<Saddle> saddle = read_saddle(level, at, radius_px, kMinContrast);
            if (saddle) {
                saddles.push_back(*saddle);
                break;
            }
        }
        if (saddles.size() == most)
            break;
    }
    return saddles;
}

} // namespace dicot::calibration
