#include "surfaces.h"

#include "doubt.h"
#include "neighbourhood.h"
#include "plane_sums.h"
#include "scene_plane.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace dicot::matching {
namespace {

constexpr int kRoundsWhenDense = 4, kRounds = 3, kRoundsAfterChoice = 1;
constexpr int kOnePx = 1 << kSlopeBits;
/// Neighbours farther from the plane than this are of another surface; wider in the first fit, which knows no slope.
constexpr int kSameSurface = kOnePx;
constexpr int kSameSurfaceAtFirst = 3 * kOnePx / 2;
/// In dense maps, what would end farther from the winner, 1/256 px, stays where it was: rims that follow the wrong
/// surface would spread. (Without filling, slanted leaves gain more from free moves than rims lose.)
constexpr int kFarthestWhenDense = 128;
/// A round moves a pixel by no more.
constexpr int kLongestStep = kOnePx / 2;
/// Where the pictures differ by more, 40 grey levels, they do not show the same.
constexpr int kSameBrightness = 40 << 4;
constexpr std::int16_t kUnknown = INT16_MIN;
/// No pixel mismatches a plane by more, 20 grey levels in 1/16; what hides one would decide alone.
constexpr int kMostMismatch = 20 << 4;
/// Another plane must mismatch by this much less, 0.3 grey levels in 1/256, and by a sixth of the rest.
constexpr int kClearlyLess = 77;
/// Where the planes of other surfaces are looked for, px right and down of a pixel.
constexpr struct
{
    int dx, dy;
} kAround[] = {{-2, 0},  {2, 0},  {0, -2}, {0, 2}, {-4, 0}, {4, 0}, {0, -4}, {0, 4},
               {-4, -4}, {4, -4}, {-4, 4}, {4, 4}, {-7, 0}, {7, 0}, {0, -7}, {0, 7}};
/// Planes that are nearer to each other are one.
constexpr int kSamePlane = kOnePx / 2;
/// Partners in the first columns of the right picture are not believed: the best one may lie beyond.
constexpr int kFirstPartner = 3;
/// Neighbours of the shift: a square of 9, every pixel; of the planes: 17, every second one.
constexpr int kShiftReach = 4, kShiftStride = 1;
constexpr int kFitReach = SurfaceRefiner::kReach, kFitStride = 2;
/// Of the confidence: a square of 9, every second one.
constexpr int kRateReach = 4, kRateStride = 2;

/// Catmull and Rom's cubic through four values, `t` of kSlopeBits fraction bits from the second to the third.
int cubic(const std::int16_t* p, int t)
{
    int sum = 3 * (p[1] - p[2]) + p[3] - p[0];
    sum = 2 * p[0] - 5 * p[1] + 4 * p[2] - p[3] + (sum * t >> kSlopeBits);
    sum = p[2] - p[0] + (sum * t >> kSlopeBits);
    return p[1] + (sum * t >> (kSlopeBits + 1));
}

/// Sums of a shift's least squares. Weight <= 127, |difference| <= 640, |gradient| < 2^14, 81 neighbours: every sum of
/// two factors is below 2^42, products of two sums below 2^55.
struct ShiftSums
{
    std::int64_t one = 0, gradient = 0, difference = 0, squares = 0, products = 0, power = 0;

    void add(std::int64_t weight, int difference_here, int gradient_here)
    {
        one += weight;
        gradient += weight * gradient_here;
        difference += weight * difference_here;
        squares += weight * gradient_here * gradient_here;
        products += weight * difference_here * gradient_here;
        power += weight * difference_here * difference_here;
    }

    /// How much the differences scatter, (1/16 grey level)^2.
    std::int64_t variance() const { return power / one - (difference / one) * (difference / one); }
};
/// (grey level / px)^2 with the full weight, in units of `squares`.
constexpr std::int64_t kSquareUnit = std::int64_t{64 * 64} * 128;
/// Noise has gradients too: this much is none.
constexpr std::int64_t kNoTexture = 30 * kSquareUnit;

} // namespace

void SurfaceRefiner::lay_out(Arena& arena, const Scene& scene)
{
    for (ImageView<std::int16_t>* plane : {&left_, &right_, &difference_, &gradient_, &doubt_})
        *plane = take_plane<std::int16_t>(arena, scene);
    texture_ = take_plane<std::uint16_t>(arena, scene);
    slopes_ = take_plane<Slope>(arena, scene);
    next_ = take_plane<Slope>(arena, scene);
}

void SurfaceRefiner::read_brightness(const Scene& scene, Crew& crew)
{
    // ITU-R BT.601 luma.
    const auto read = [](CostRow row, int first, int last, int shift, std::int16_t* to) {
        for (int x = first; x < last; ++x) {
            const int c = x + shift;
            to[x] = static_cast<std::int16_t>((77 * row.red[c] + 150 * row.green[c] + 29 * row.blue[c]) >> 4);
        }
    };
    // Columns of the right picture that lie outside its search frame are never looked up.
    const int first = std::max(0, -(scene.axis - 1) - kReach - scene.min_disparity);
    const int last = std::min(scene.width, scene.width + kReach - scene.min_disparity);
    crew.run(scene.height, [&](int y) {
        read(scene.left.cost(y), 0, scene.width, 0, left_.row(y));
        std::fill_n(right_.row(y), scene.width, std::int16_t{0});
        read(scene.right.cost(y), first, last, scene.min_disparity, right_.row(y));
    });
}

void SurfaceRefiner::look_up(const Scene& scene, const Maps& maps, Crew& crew)
{
    crew.run(scene.height, [&](int y) {
        const std::int16_t* left = left_.row(y);
        const std::int16_t* right = right_.row(y);
        for (int x = 0; x < scene.width; ++x) {
            difference_.row(y)[x] = kUnknown;
            const Slope& own = slopes_.row(y)[x];
            if (maps.verdict.row(y)[x] != Verdict::kMatched || own.disparity == kNoSlope || x < 1 ||
                x + 1 >= scene.width)
                continue;
            const int position = ((x - scene.min_disparity) << kSlopeBits) - own.disparity;
            const int column = position >> kSlopeBits;
            const int t = position & (kOnePx - 1);
            if (column < 1 || column + 2 >= scene.width)
                continue;
            const int difference = left[x] - cubic(right + column - 1, t);
            if (std::abs(difference) > kSameBrightness)
                continue;
            const int before = right[column + 1] - right[column - 1];
            const int after = right[column + 2] - right[column];
            difference_.row(y)[x] = static_cast<std::int16_t>(difference);
            gradient_.row(y)[x] =
                static_cast<std::int16_t>(left[x + 1] - left[x - 1] + before + ((after - before) * t >> kSlopeBits));
        }
    });
}

void SurfaceRefiner::shift_row(const Scene& scene, const Maps& maps, int y)
{
    Neighbourhood<kShiftReach, kShiftStride>::sweep(scene, y, [&](int x, const auto& neighbours) {
        const Slope own = slopes_.row(y)[x];
        next_.row(y)[x] = own;
        texture_.row(y)[x] = 0;
        doubt_.row(y)[x] = kHopeless;
        if (own.disparity == kNoSlope)
            return;
        ShiftSums sums;
        neighbours([&](int weight, int dx, int dy) {
            const int difference = difference_.row(y + dy)[x + dx];
            if (difference == kUnknown)
                return;
            const int plane = own.disparity + own.across * dx + own.down * dy;
            if (std::abs(slopes_.row(y + dy)[x + dx].disparity - plane) <= kSameSurface)
                sums.add(weight, difference, gradient_.row(y + dy)[x + dx]);
        });
        if (sums.one == 0)
            return;
        const std::int64_t squares = sums.squares - sums.gradient * sums.gradient / sums.one;
        const std::int64_t products = sums.products - sums.difference * sums.gradient / sums.one;
        // A difference is in 1/16, a gradient in 1/64 grey level.
        const std::int64_t step = -(products * (4 << kSlopeBits)) / (squares + kNoTexture);
        next_.row(y)[x].disparity +=
            static_cast<std::int32_t>(std::clamp<std::int64_t>(step, -kLongestStep, kLongestStep));
        const std::int64_t texture = std::min<std::int64_t>(squares / kSquareUnit + 1, PlaneSums::kMostWeight);
        doubt_.row(y)[x] = doubt_of_shift(sums.variance(), texture, sums.one);
        if (maps.verdict.row(y)[x] == Verdict::kMatched)
            texture_.row(y)[x] = static_cast<std::uint16_t>(texture);
    });
}

void SurfaceRefiner::fit_row(const Scene& scene, int y, int same_surface)
{
    Neighbourhood<kFitReach, kFitStride>::sweep(scene, y, [&](int x, const auto& neighbours) {
        const Slope own = slopes_.row(y)[x];
        next_.row(y)[x] = own;
        if (own.disparity == kNoSlope)
            return;
        PlaneSums sums;
        std::int64_t asked = 0, agreed = 0, deviation = 0;
        neighbours([&](int weight, int dx, int dy) {
            asked += weight;
            const std::int32_t disparity = slopes_.row(y + dy)[x + dx].disparity;
            const int texture = texture_.row(y + dy)[x + dx];
            if (disparity == kNoSlope || texture == 0)
                return;
            const int rise = disparity - own.disparity;
            const int off = std::abs(rise - own.across * dx - own.down * dy);
            if (off > same_surface)
                return;
            sums.add(std::int64_t{weight} * texture, dx, dy, rise);
            agreed += weight;
            deviation += std::int64_t{weight} * texture * off;
        });
        if (sums.one == 0) {
            doubt_.row(y)[x] = kHopeless;
            return;
        }
        if (doubt_.row(y)[x] != kHopeless)
            doubt_.row(y)[x] =
                static_cast<std::int16_t>(doubt_.row(y)[x] + doubt_of_plane(agreed, asked, deviation / sums.one));
        const PlaneSums::Plane plane = sums.plane();
        if (std::abs(plane.centre) >= kOnePx)
            return;
        next_.row(y)[x] = {own.disparity + plane.centre, static_cast<std::int16_t>(plane.across),
                           static_cast<std::int16_t>(plane.down)};
    });
}

void SurfaceRefiner::fit_planes(const Scene& scene, Crew& crew, int same_surface)
{
    crew.run(scene.height, [&](int y) { fit_row(scene, y, same_surface); });
    std::swap(slopes_, next_);
}

template <typename Visit>
void SurfaceRefiner::visit_planes(const Scene& scene, int x, int y, Visit&& visit) const
{
    for (const auto [dx, dy] : kAround) {
        if (x + dx < 0 || x + dx >= scene.width || y + dy < 0 || y + dy >= scene.height)
            continue;
        const Slope there = slopes_.row(y + dy)[x + dx];
        if (there.disparity == kNoSlope || doubt_.row(y + dy)[x + dx] > kDoubtfulPlane)
            continue;
        const std::int32_t here = there.disparity - there.across * dx - there.down * dy;
        const int partner = x - scene.min_disparity - (here >> kSlopeBits);
        if (here >= 0 && here < scene.disparities << kSlopeBits && partner >= kFirstPartner)
            visit(Slope{here, there.across, there.down});
    }
}

template <typename Neighbours>
int SurfaceRefiner::mismatch(const Scene& scene, int x, int y, Slope plane, const Neighbours& neighbours) const
{
    const int partner = x - (plane.disparity >> kSlopeBits); // in the search frame
    const LabRow centre = scene.right.lab(y);
    std::int64_t one = 0, sum = 0;
    neighbours([&](int weight, int dx, int dy) {
        const int position =
            ((x + dx - scene.min_disparity) << kSlopeBits) - (plane.disparity + plane.across * dx + plane.down * dy);
        const int column = position >> kSlopeBits;
        if (column < 0 || column + 1 >= scene.width)
            return;
        const int right_weight =
            scene.colour.between(centre, partner, scene.right.lab(y + dy), column + scene.min_disparity) >> 8;
        const std::int16_t* right = right_.row(y + dy) + column;
        const int between = right[0] + ((right[1] - right[0]) * (position & (kOnePx - 1)) >> kSlopeBits);
        one += weight * right_weight;
        sum += weight * right_weight * std::min(std::abs(left_.row(y + dy)[x + dx] - between), kMostMismatch);
    });
    return static_cast<int>(one > 0 ? sum * 16 / one : kMostMismatch * 16);
}

Slope SurfaceRefiner::nearest_plane(const Scene& scene, int x, int y, std::int32_t winner) const
{
    Slope nearest{kNoSlope, 0, 0};
    int least = kOnePx;
    visit_planes(scene, x, y, [&](Slope plane) {
        const int apart = std::abs(plane.disparity - winner);
        if (apart < least) {
            least = apart;
            nearest = plane;
        }
    });
    return nearest;
}

void SurfaceRefiner::choose_row(const Scene& scene, const Maps& maps, int y)
{
    Neighbourhood<kShiftReach, kShiftStride>::sweep(scene, y, [&](int x, const auto& neighbours) {
        const Slope own = slopes_.row(y)[x];
        Slope& chosen = next_.row(y)[x];
        chosen = own;
        if (own.disparity == kNoSlope) {
            if (maps.verdict.row(y)[x] == Verdict::kMismatched)
                chosen = nearest_plane(scene, x, y, maps.disparity.row(y)[x] << (kSlopeBits - kDispFractionBits));
            return;
        }
        std::array<std::int32_t, std::size(kAround) + 1> tried{own.disparity};
        std::size_t count = 1;
        int least = 0;
        visit_planes(scene, x, y, [&](Slope plane) {
            const auto known = [&](std::int32_t d) { return std::abs(d - plane.disparity) < kSamePlane; };
            if (std::any_of(tried.begin(), tried.begin() + count, known))
                return;
            tried[count++] = plane.disparity;
            if (least == 0)
                least = (mismatch(scene, x, y, own, neighbours) - kClearlyLess) * 5 / 6;
            const int there = mismatch(scene, x, y, plane, neighbours);
            if (there < least) {
                least = there;
                chosen = plane;
            }
        });
    });
}

void SurfaceRefiner::run_rounds(const Scene& scene, const Maps& maps, int rounds, Crew& crew)
{
    for (int round = 0; round < rounds; ++round) {
        look_up(scene, maps, crew);
        crew.run(scene.height, [&](int y) { shift_row(scene, maps, y); });
        std::swap(slopes_, next_);
        fit_planes(scene, crew, kSameSurface);
    }
}

void SurfaceRefiner::refine(const Scene& scene, const Maps& maps, bool dense, Crew& crew)
{
    constexpr int kMoreBits = kSlopeBits - kDispFractionBits;
    crew.run(scene.height, [&](int y) {
        for (int x = 0; x < scene.width; ++x) {
            const DispQ8 d = maps.disparity.row(y)[x];
            const bool matched = d != kDispMissing && maps.verdict.row(y)[x] == Verdict::kMatched;
            slopes_.row(y)[x] = {matched ? d << kMoreBits : kNoSlope, 0, 0};
            texture_.row(y)[x] = 1;
            doubt_.row(y)[x] = 0;
        }
    });
    read_brightness(scene, crew);
    fit_planes(scene, crew, kSameSurfaceAtFirst);
    fit_planes(scene, crew, kSameSurface);
    run_rounds(scene, maps, dense ? kRoundsWhenDense : kRounds, crew);
    if (!dense) {
        crew.run(scene.height, [&](int y) { choose_row(scene, maps, y); });
        std::swap(slopes_, next_);
        run_rounds(scene, maps, kRoundsAfterChoice, crew);
    }
    crew.run(scene.height, [&](int y) { settle_row(scene, maps, y, dense); });
    crew.run(scene.height, [&](int y) { rate_row(scene, maps, y, dense); });
}

void SurfaceRefiner::settle_row(const Scene& scene, const Maps& maps, int y, bool dense)
{
    constexpr int kFewerBits = kSlopeBits - kDispFractionBits;
    const int most = (scene.disparities - 1) << kDispFractionBits;
    for (int x = 0; x < scene.width; ++x) {
        const std::int32_t d = slopes_.row(y)[x].disparity;
        DispQ8& was = maps.disparity.row(y)[x];
        std::int16_t& doubt = doubt_.row(y)[x];
        if (d == kNoSlope) {
            was = kDispMissing;
            doubt = kHopeless;
            continue;
        }
        const int is = std::clamp((d + (1 << (kFewerBits - 1))) >> kFewerBits, 0, most);
        const int moved = std::abs(is - was);
        doubt = static_cast<std::int16_t>(
            std::min<int>(doubt + doubt_of_winner(moved, maps.confidence.row(y)[x]), kHopeless));
        if (!dense || moved <= kFarthestWhenDense)
            was = static_cast<DispQ8>(is);
    }
}

int SurfaceRefiner::doubt_on_plane(const Scene& scene, int x, int y, int dx, int dy) const
{
    if (x + dx < 0 || x + dx >= scene.width || y + dy < 0 || y + dy >= scene.height)
        return kHopeless;
    const Slope own = slopes_.row(y)[x];
    const std::int32_t there = slopes_.row(y + dy)[x + dx].disparity;
    const std::int32_t plane = own.disparity + own.across * dx + own.down * dy;
    return there != kNoSlope && std::abs(there - plane) <= kSameSurface ? doubt_.row(y + dy)[x + dx] : kHopeless;
}

void SurfaceRefiner::rate_row(const Scene& scene, const Maps& maps, int y, bool dense) const
{
    for (int x = 0; x < scene.width; ++x) {
        std::uint8_t& confidence = maps.confidence.row(y)[x];
        const Slope own = slopes_.row(y)[x];
        confidence = 0;
        if (own.disparity == kNoSlope)
            continue;
        int least = kHopeless;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                least = std::min(least, doubt_on_plane(scene, x, y, dx, dy));
        if (doubt_of_value(doubt_.row(y)[x], least, std::abs(own.across) + std::abs(own.down)) >= kMostDoubt) {
            if (dense)
                confidence = 1;
            else
                maps.disparity.row(y)[x] = kDispMissing;
            continue;
        }
        int sum = 0, count = 0;
        for (int dy = -kRateReach; dy <= kRateReach; dy += kRateStride) {
            for (int dx = -kRateReach; dx <= kRateReach; dx += kRateStride) {
                sum += std::min(doubt_on_plane(scene, x, y, dx, dy), kDoubtOfOthers);
                ++count;
            }
        }
        const int top = (scene.min_disparity + scene.disparities) << kSlopeBits;
        confidence = confidence_of(sum / count, (scene.min_disparity << kSlopeBits) + own.disparity, top);
    }
}

} // namespace dicot::matching
