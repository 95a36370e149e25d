#include "leaf_surface.h"

#include "vec3.h"

#include <algorithm>
#include <cmath>

namespace dicot {
namespace {

constexpr double kSmoothing_mm = 4;
/// A cell sees at most as much surface as under 83 degrees.
constexpr double kSteepest = 8;

struct Sums
{
    double n = 0, u = 0, v = 0, q = 0, uu = 0, uv = 0, vv = 0, uq = 0, vq = 0;

    void add(double du, double dv, double inverse_z)
    {
        n += 1;
        u += du;
        v += dv;
        q += inverse_z;
        uu += du * du;
        uv += du * dv;
        vv += dv * dv;
        uq += du * inverse_z;
        vq += dv * inverse_z;
    }
};

/// 1/z at the middle, and what it gains a pixel.
struct InverseDepth
{
    double at = 0, along_u = 0, along_v = 0;
};

InverseDepth plane_through(const Sums& s, double own)
{
    const double suu = s.uu - s.u * s.u / s.n, svv = s.vv - s.v * s.v / s.n, suv = s.uv - s.u * s.v / s.n;
    const double determinant = suu * svv - suv * suv;
    if (s.n < 6 || determinant < 1e-3 * suu * svv || determinant <= 0)
        return {own, 0, 0};
    const double suq = s.uq - s.u * s.q / s.n, svq = s.vq - s.v * s.q / s.n;
    InverseDepth plane;
    plane.along_u = (suq * svv - svq * suv) / determinant;
    plane.along_v = (svq * suu - suq * suv) / determinant;
    plane.at = (s.q - plane.along_u * s.u - plane.along_v * s.v) / s.n;
    return plane.at > own / 2 && plane.at < own * 2 ? plane : InverseDepth{own, 0, 0};
}

class Smoother
{
public:
    Smoother(const PlantView& view, const Leaves& leaves) : view_(view), leaves_(leaves), step_mm_(view.mm_per_step())
    {
    }

    double z_mm(std::int32_t point) const { return view_.cloud.points[static_cast<std::size_t>(point)].z * step_mm_; }
    int leaf_at(int column, int row) const
    {
        const std::int32_t point = view_.point.at(column, row);
        return point == PlantView::kNoPoint ? Leaves::kNone : leaves_.leaf[static_cast<std::size_t>(point)];
    }

    /// `residual_mm`: how far the point stands from its plane.
    SurfaceCell cell(int column, int row, double& residual_mm) const
    {
        const std::int32_t point = view_.point.at(column, row);
        const double own = 1 / z_mm(point);
        const InverseDepth plane = plane_through(around(column, row, point), own);
        const double z = 1 / plane.at;
        residual_mm = (own - plane.at) * z * z;
        const double x = (column - view_.cx_px) / view_.focal_px, y = (row - view_.cy_px) / view_.focal_px;
        // A X + B Y + C Z = 1 with A, B = focal * gradient; a cell's area is z^3 |(A, B, C)| / focal^2.
        const double a = view_.focal_px * plane.along_u, b = view_.focal_px * plane.along_v;
        const double c = plane.at - a * x - b * y;
        const double across = std::sqrt(a * a + b * b + c * c);
        const double area = std::min(z * across, kSteepest) * z * z / (view_.focal_px * view_.focal_px);
        const double upright = std::fabs(dot({a, b, c}, vec3(leaves_.ground.up))) / across;
        return {static_cast<float>(x * z), static_cast<float>(y * z),          static_cast<float>(z),
                static_cast<float>(area),  static_cast<float>(area * upright), point};
    }

private:
    Sums around(int column, int row, std::int32_t point) const
    {
        const int leaf = leaves_.leaf[static_cast<std::size_t>(point)];
        const double z = z_mm(point);
        const int radius = static_cast<int>(std::clamp(kSmoothing_mm * view_.focal_px / z + 0.5, 2.0, 32.0));
        const int stride = std::max(1, radius / 3); // 49 places or a little more
        const int reach = radius / stride * stride;
        const double farthest = 6 * kSmoothing_mm;
        Sums sums;
        for (int dv = -reach; dv <= reach; dv += stride) {
            if (row + dv < 0 || row + dv >= view_.point.height)
                continue;
            for (int du = -reach; du <= reach; du += stride) {
                if (column + du < 0 || column + du >= view_.point.width || du * du + dv * dv > radius * radius)
                    continue;
                const std::int32_t other = view_.point.at(column + du, row + dv);
                if (other == PlantView::kNoPoint || leaves_.leaf[static_cast<std::size_t>(other)] != leaf)
                    continue;
                const double other_z = z_mm(other);
                if (std::fabs(other_z - z) < farthest)
                    sums.add(du, dv, 1 / other_z);
            }
        }
        return sums;
    }

    const PlantView& view_;
    const Leaves& leaves_;
    double step_mm_;
};

/// The step from surface to surface hides as many cells from the right camera as their disparities differ by: focal *
/// baseline * step / (near * far). The baseline is not known here; what stands at a distance is seen well with an
/// eighth of it. Two cells more are holes.
constexpr double kBaselineShare = 0.125;
constexpr double kHole = 2;

/// Cells without a point between two points of a row belong to the farther of the two, which is what the right camera
/// does not see behind the nearer one; or to the leaf that both are of. That is what lies to the left of something
/// nearer. To the right of it the right camera sees more than the left one: what has no point there is hidden by
/// nothing, and is leaf where both are.
void find_gaps(const PlantView& view, const Smoother& smoother, std::span<LeafGaps> gaps)
{
    const int widest = view.point.width / 16;
    for (int row = 0; row < view.point.height; ++row) {
        int last = -1;
        for (int column = 0; column < view.point.width; ++column) {
            const std::int32_t point = view.point.at(column, row);
            if (point == PlantView::kNoPoint)
                continue;
            const int missing = column - last - 1;
            if (last >= 0 && missing > 0 && missing <= widest) {
                const int left = smoother.leaf_at(last, row), right = smoother.leaf_at(column, row);
                const std::int32_t before = view.point.at(last, row);
                const bool nearer_right = smoother.z_mm(before) >= smoother.z_mm(point);
                const int farther = nearer_right ? left : right;
                if (farther != Leaves::kNone && (nearer_right || left != Leaves::kNone)) {
                    LeafGaps& gap = gaps[static_cast<std::size_t>(farther - 1)];
                    const double near = std::min(smoother.z_mm(before), smoother.z_mm(point));
                    const double step = std::fabs(smoother.z_mm(before) - smoother.z_mm(point));
                    const double hidden = kHole + kBaselineShare * view.focal_px * step / near;
                    if (left == right)
                        gap.inside_cells += static_cast<float>(missing);
                    else
                        gap.beside_cells += static_cast<float>(std::min<double>(missing, hidden));
                }
            }
            last = column;
        }
    }
}

} // namespace

LeafSurfaces leaf_surfaces(const PlantView& view, const Leaves& leaves, Arena& arena)
{
    const auto count = static_cast<std::size_t>(leaves.leaf_count);
    LeafSurfaces surfaces;
    surfaces.first = arena.take<std::int32_t>(count + 1);
    surfaces.gaps = arena.take<LeafGaps>(count);
    surfaces.blade = arena.take<std::int32_t>(count);
    surfaces.cells = arena.take<SurfaceCell>(view.cloud.points.size());
    if (arena.overrun() || arena.measuring())
        return {};
    const Smoother smoother(view, leaves);
    std::ranges::fill(surfaces.first, 0);
    std::ranges::fill(surfaces.gaps, LeafGaps{});
    const auto each_leaf_cell = [&](const auto& visit) {
        for (int row = 0; row < view.point.height; ++row)
            for (int column = 0; column < view.point.width; ++column)
                if (const int leaf = smoother.leaf_at(column, row); leaf != Leaves::kNone)
                    visit(column, row, static_cast<std::size_t>(leaf));
    };
    each_leaf_cell([&](int, int, std::size_t leaf) { ++surfaces.first[leaf]; });
    for (std::size_t leaf = 1; leaf <= count; ++leaf)
        surfaces.first[leaf] += surfaces.first[leaf - 1];
    // first[leaf - 1] runs to the end of its leaf, and is set back afterwards.
    each_leaf_cell([&](int column, int row, std::size_t leaf) {
        double residual_mm = 0;
        surfaces.cells[static_cast<std::size_t>(surfaces.first[leaf - 1]++)] = smoother.cell(column, row, residual_mm);
        surfaces.gaps[leaf - 1].noise_mm += static_cast<float>(residual_mm * residual_mm);
    });
    for (std::size_t leaf = count; leaf > 0; --leaf)
        surfaces.first[leaf] = surfaces.first[leaf - 1];
    surfaces.first[0] = 0;
    for (std::size_t i = 0; i < count; ++i) {
        surfaces.blade[i] = surfaces.first[i + 1] - surfaces.first[i];
        const auto cells = static_cast<float>(std::max(1, surfaces.blade[i]));
        surfaces.gaps[i].noise_mm = std::sqrt(surfaces.gaps[i].noise_mm / cells);
    }
    find_gaps(view, smoother, surfaces.gaps);
    return surfaces;
}

} // namespace dicot
