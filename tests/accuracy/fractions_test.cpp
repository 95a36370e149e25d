// Sub-pixel disparities on slanted planes must take all fractions alike: no pixel locking.
#include "calibration_data.h"
#include "csv_lines.h"
#include "matched.h"
#include "rectified_view.h"
#include "sgbm.h"
#include "spotted_wall.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace dicot::test {
namespace {

constexpr int kBins = 10;

/// How often disparities have a fraction within half a tenth of 0, 0.1 .. 0.9 px.
struct Fractions
{
    std::array<long, kBins> counts{};
    long all = 0;

    void add(double disparity_px)
    {
        const auto tenths = static_cast<long>(std::floor(disparity_px * kBins + 0.5));
        ++counts[static_cast<std::size_t>((tenths % kBins + kBins) % kBins)];
        ++all;
    }
    double percent(std::size_t bin) const { return 100 * static_cast<double>(counts[bin]) / static_cast<double>(all); }
};

/// One surface or several, as they are and as two matchers saw them.
struct Seen
{
    Fractions truth, ours, peer;
    std::vector<double> ours_off, peer_off; ///< px, of those within 1 px

    void add(double true_px, float ours_px, float peer_px)
    {
        truth.add(true_px);
        note(ours, ours_off, ours_px, true_px);
        note(peer, peer_off, peer_px, true_px);
    }
    /// The emptiest tenth of `seen` against its fullest, each beside its true share. 1: none is preferred.
    double evenness(const Fractions& seen) const
    {
        double least = 1e9, most = 0;
        for (std::size_t bin = 0; bin < kBins; ++bin) {
            const double share = seen.percent(bin) / truth.percent(bin);
            least = std::min(least, share);
            most = std::max(most, share);
        }
        return least / most;
    }
    void print(const char* name) const
    {
        std::printf("%s: share of each tenth of a pixel, %%; truth, ours, SGBM\n", name);
        for (std::size_t bin = 0; bin < kBins; ++bin) {
            const auto bar = [&](const Fractions& seen) {
                return std::string(static_cast<std::size_t>(std::lround(seen.percent(bin))), '#');
            };
            std::printf("  0.%zu  %5.2f %-16s %5.2f %-24s %5.2f %s\n", bin, truth.percent(bin), bar(truth).c_str(),
                        ours.percent(bin), bar(ours).c_str(), peer.percent(bin), bar(peer).c_str());
        }
        std::printf("  emptiest against fullest: ours %.2f, SGBM %.2f; error: ours %.3f px, SGBM %.3f px (root mean "
                    "square of those within 1 px, %.1f %% and %.1f %% of %ld)\n",
                    evenness(ours), evenness(peer), rms(ours_off), rms(peer_off), share(ours_off), share(peer_off),
                    truth.all);
    }
    double share(const std::vector<double>& off) const
    {
        return 100 * static_cast<double>(off.size()) / static_cast<double>(truth.all);
    }

private:
    static void note(Fractions& seen, std::vector<double>& off, float px, double true_px)
    {
        const double difference = static_cast<double>(px) - true_px;
        if (!(std::fabs(difference) <= 1))
            return;
        seen.add(static_cast<double>(px));
        off.push_back(difference);
    }
    static double rms(const std::vector<double>& off)
    {
        double squares = 0;
        for (const double d : off)
            squares += d * d;
        return std::sqrt(squares / static_cast<double>(off.size()));
    }
};

struct Matches
{
    Disparities ours, peer;
};

Matches matched_by_both(const scenes::Picture& left, const scenes::Picture& right, const DisparityRange& range)
{
    MatchOptions options;
    options.method = MatchMethod::kBest;
    options.min_disparity = range.min_disparity;
    options.disparities = range.disparities;
    return {disparities_of(Matched(left.view(), right.view(), options).map()), sgbm_hh(left, right, range)};
}

/// A box's face: 210 x 280 mm, upright.
struct Face
{
    Point3 centre, normal;

    /// How far along a ray of the left camera (in multiples of it) the face is; 0 beside it or within 20 mm of its rim.
    double way(const Point3& ray) const
    {
        constexpr double kHalfWidth = 105 - 20, kHalfHeight = 140 - 20;
        const auto dot = [](const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
        const double t = dot(centre, normal) / dot(ray, normal);
        const Point3 at{t * ray.x - centre.x, t * ray.y - centre.y, t * ray.z - centre.z};
        const bool inside =
            std::fabs(at.z * normal.x - at.x * normal.z) <= kHalfWidth && std::fabs(at.y) <= kHalfHeight;
        return inside ? t : 0;
    }
};

scenes::Picture cut(const scenes::Picture& from, int x0, int y0, int width, int height)
{
    scenes::Picture piece{width, height, {}};
    for (int y = 0; y < height; ++y)
        piece.pixels.insert(piece.pixels.end(), from.view().row(y0 + y) + x0, from.view().row(y0 + y) + x0 + width);
    return piece;
}

void add_face(const RectifiedView& view, const Face& face, const std::string& stem, Seen& all)
{
    const Rectification& flat = view.flat();
    const Turn back = transposed(flat.left_rectifying);
    std::map<std::pair<int, int>, double> true_px; // by row, column
    int x0 = flat.width, x1 = 0, y0 = flat.height, y1 = 0;
    for (int y = 0; y < flat.height; ++y)
        for (int x = 0; x < flat.width; ++x) {
            const Point3 ray = turned(back, {(x - flat.cx_px) / flat.focal_px, (y - flat.cy_px) / flat.focal_px, 1});
            const double way = face.way(ray);
            if (way <= 0)
                continue;
            true_px[{y, x}] = flat.focal_px * flat.baseline_mm / way;
            x0 = std::min(x0, x);
            x1 = std::max(x1, x);
            y0 = std::min(y0, y);
            y1 = std::max(y1, y);
        }
    constexpr int kMargin = 40; // px: the support windows' reach
    const DisparityRange range = view.range();
    x0 = std::max(0, x0 - kMargin - range.min_disparity - range.disparities);
    y0 = std::max(0, y0 - kMargin);
    const int width = std::min(flat.width, x1 + kMargin) - x0, height = std::min(flat.height, y1 + kMargin) - y0;
    const scenes::Picture left = view.left(scenes::read(stem + "_left.jpg"));
    const scenes::Picture right = view.right(scenes::read(stem + "_right.jpg"));
    const Matches found = matched_by_both(cut(left, x0, y0, width, height), cut(right, x0, y0, width, height), range);
    for (const auto& [at, px] : true_px) {
        const auto i = static_cast<std::size_t>((at.first - y0) * width + at.second - x0);
        all.add(px, found.ours.px[i], found.peer.px[i]);
    }
}

TEST(Fractions, NoneIsPreferredOnSlantedBoxes)
{
    if (!data_there("rig-dev/box_slanted"))
        return;
    const RectifiedView view(rig_dev_truth());
    const std::string folder = data_path("rig-dev/box_slanted/");
    Seen all;
    for (const std::vector<std::string>& line : csv_lines(folder + "gt_box_slanted.csv")) {
        constexpr std::size_t kName = 0, kNormal = 5, kCentre = 8;
        const auto triple = [&](std::size_t i) {
            return Point3{std::stod(line[i]), std::stod(line[i + 1]), std::stod(line[i + 2])};
        };
        add_face(view, {triple(kCentre), triple(kNormal)}, folder + line[kName], all);
    }
    all.print("slanted boxes");
    EXPECT_GE(all.evenness(all.ours), 0.5);
    EXPECT_GE(all.share(all.ours_off), 90);
}

TEST(Fractions, NoneIsPreferredOnADrawnSlope)
{
    constexpr int kWidth = 320, kHeight = 240;
    constexpr double kLeast = 20, kAcross = 0.06, kDown = 0.02; // px of disparity, and px of it for each px
    const SpottedWall large(5), middling(6), small(7);
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, 2);
    scenes::Picture left{kWidth, kHeight, {}}, right = left;
    const auto level = [&](double x, double y) {
        const double u = x - 100, v = y - 100;
        const double bright = large.at(u, v) + middling.at(1.4 * u, 1.4 * v) + small.at(2 * u, 2 * v) - 2 * 128;
        const auto value = static_cast<std::uint8_t>(std::clamp(bright + noise(random), 0.0, 255.0));
        return Rgb8{value, value, value};
    };
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            left.pixels.push_back(level(x, y));
            right.pixels.push_back(level((x + kLeast + kDown * y) / (1 - kAcross), y));
        }
    const Matches found = matched_by_both(left, right, {8, 48});
    Seen all;
    for (int y = 20; y < kHeight - 20; ++y)
        for (int x = 80; x < kWidth - 20; ++x) {
            const auto i = static_cast<std::size_t>(y * kWidth + x);
            all.add(kLeast + kAcross * x + kDown * y, found.ours.px[i], found.peer.px[i]);
        }
    all.print("a drawn slope");
    EXPECT_GE(all.evenness(all.ours), 0.5);
    EXPECT_GE(all.share(all.ours_off), 95);
}

} // namespace
} // namespace dicot::test
