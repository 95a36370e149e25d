#include "leaf_shape.h"

#include "parabola.h"
#include "principal_axes.h"
#include "quadric.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace dicot {
namespace {

constexpr int kMostSections = 96;

struct Section
{
    double least = 0, most = 0; ///< across
    int cells = 0;

    double middle() const { return (least + most) / 2; }
    double width() const { return most - least; }
};

/// The leaf cut across its length into strips of one width.
struct Sections
{
    std::array<Section, kMostSections> all;
    int count = 0;
    double start = 0, step = 0;

    int of(double along) const { return std::clamp(static_cast<int>((along - start) / step), 0, count - 1); }
    double along(int i) const { return start + (i + 0.5) * step; }
};

Vec3 where(const SurfaceCell& cell)
{
    return {cell.x, cell.y, cell.z};
}

Sections sections_of(std::span<const Place> places, double spacing_mm)
{
    const auto [first, last] = std::ranges::minmax_element(places, {}, &Place::along);
    const double extent = std::max(1e-6, double(last->along) - double(first->along));
    Sections sections;
    sections.count = static_cast<int>(std::clamp(extent / (1.5 * spacing_mm), 4.0, double(kMostSections)));
    sections.start = first->along;
    sections.step = extent / sections.count;
    for (const Place& place : places) {
        Section& section = sections.all[static_cast<std::size_t>(sections.of(place.along))];
        section.least = section.cells == 0 ? place.across : std::min<double>(section.least, place.across);
        section.most = section.cells == 0 ? place.across : std::max<double>(section.most, place.across);
        ++section.cells;
    }
    return sections;
}

/// Through the middles of the inner four fifths; the ends, where one border cell more or less counts most, are left
/// out.
Parabola midrib_of(const Sections& sections)
{
    std::array<Sample, kMostSections> samples;
    std::size_t count = 0;
    for (int i = sections.count / 10; i < sections.count - sections.count / 10; ++i) {
        const Section& section = sections.all[static_cast<std::size_t>(i)];
        if (section.cells > 0)
            samples[count++] = {sections.along(i), section.middle(), section.width()};
    }
    return fit_parabola(std::span(samples).first(count));
}

/// How far apart neighbouring cells stand on the surface in this direction.
double spacing_mm(Vec3 centre, Vec3 direction, double focal_px)
{
    const Vec3 ray = unit(centre);
    const double facing = length(direction - dot(direction, ray) * ray);
    constexpr double kEdgeOn = 0.15;
    return centre.z / focal_px / std::max(facing, kEdgeOn);
}

struct MidribEnd
{
    double along = 0, across = 0;
    bool sinus = false;
};

class Measure
{
public:
    Measure(const LeafShape& shape, std::span<const Place> places)
        : shape_(shape), places_(places), sections_(sections_of(places, shape.along_spacing_mm)),
          midrib_(midrib_of(sections_)), widest_(0)
    {
        for (int i = 0; i < sections_.count; ++i)
            widest_ = std::max(widest_, section(i).width());
    }

    /// `side`: -1 towards the least `along`, +1 towards the greatest.
    MidribEnd end(float side) const
    {
        const double strip = std::max(0.02 * widest_, shape_.across_spacing_mm);
        std::array<double, kMostSections> reach{};
        std::array<bool, kMostSections> crossed{};
        std::array<const Place*, 3> outermost{}; // the last of them: two may be strays
        for (const Place& place : places_) {
            const Place* candidate = &place;
            for (const Place*& held : outermost)
                if (candidate && (!held || side * candidate->along > side * held->along))
                    std::swap(held, candidate);
            if (std::fabs(place.across - midrib_(place.along)) > strip)
                continue;
            const auto i = static_cast<std::size_t>(sections_.of(place.along));
            reach[i] = crossed[i] ? side * std::max(side * reach[i], double(side * place.along)) : place.along;
            crossed[i] = true;
        }
        // From the middle outwards, over holes of a few mm.
        constexpr double kHole_mm = 3;
        const int hole = static_cast<int>(std::max(kHole_mm, 2 * shape_.along_spacing_mm) / sections_.step) + 1;
        int last = -1;
        for (int i = sections_.count / 2; i >= 0 && i < sections_.count; i += static_cast<int>(side)) {
            if (crossed[static_cast<std::size_t>(i)])
                last = i;
            else if (last >= 0 && std::abs(i - last) > hole)
                break;
        }
        const double tip_along = outermost.back()->along;
        const MidribEnd tip{tip_along, middle_at(tip_along), false};
        if (last < 0)
            return tip;
        const double ends = reach[static_cast<std::size_t>(last)];
        return two_lobes_beyond(ends, side) ? MidribEnd{ends, midrib_(ends), true} : tip;
    }

    /// Along the surface, from end to end.
    double length_mm(const MidribEnd& from, const MidribEnd& to, Parabola& profile, double& noise_mm) const
    {
        constexpr int kPieces = 16;
        std::array<Sample, kPieces> pieces{};
        const double piece_mm = std::max(1e-6, (to.along - from.along) / kPieces);
        const double strip = std::max(0.12 * widest_, 2 * shape_.across_spacing_mm);
        for (const Place& place : places_) {
            if (place.along < from.along || place.along > to.along ||
                std::fabs(place.across - midrib_(place.along)) > strip)
                continue;
            const auto i = static_cast<std::size_t>(
                std::min(static_cast<int>((place.along - from.along) / piece_mm), kPieces - 1));
            pieces[i].at += place.along;
            pieces[i].value += place.off;
            pieces[i].weight += 1;
        }
        std::size_t count = 0;
        for (const Sample& piece : pieces)
            if (piece.weight > 0)
                pieces[count++] = {piece.at / piece.weight, piece.value / piece.weight, piece.weight};
        const std::span<const Sample> path = std::span(pieces).first(count);
        profile = fit_parabola(path);
        noise_mm = 0;
        for (const Sample& piece : path)
            noise_mm += (piece.value - profile(piece.at)) * (piece.value - profile(piece.at));
        noise_mm = count > 3 ? std::sqrt(noise_mm / double(count - 3)) : 0;
        if (count < 2)
            return to.along - from.along;
        double way = 0;
        double along = from.along, across = from.across, off = extended(path[0], path[1], from.along);
        const auto go = [&](double s, double w, double h) {
            way += std::sqrt((s - along) * (s - along) + (w - across) * (w - across) + (h - off) * (h - off));
            along = s;
            across = w;
            off = h;
        };
        // The ends lie beside the parabola at most by what the outline bends there: a straight way from the last piece.
        for (const Sample& piece : path)
            if (piece.at > from.along && piece.at < to.along)
                go(piece.at, midrib_(piece.at), piece.value);
        go(to.along, to.across, extended(path[count - 1], path[count - 2], to.along));
        return way;
    }

    /// The median of three neighbouring sections, where it is widest.
    double width_mm() const
    {
        std::array<double, kMostSections> widths{};
        for (int i = 0; i < sections_.count; ++i)
            widths[static_cast<std::size_t>(i)] = section(i).width() > 0.6 * widest_ ? across_mm(i) : 0;
        double widest = 0;
        for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(sections_.count); ++i) {
            const double a = widths[i - 1], b = widths[i], c = widths[i + 1];
            widest = std::max(widest, std::max(std::min(a, b), std::min(std::max(a, b), c)));
        }
        return widest > 0 ? widest : widest_;
    }

    /// Of what the sections hold; gaps across that are wider than kBridge_mm are not leaf.
    double area_mm2(std::span<Place> sorted, const Parabola& profile) const
    {
        const auto order = [this](const Place& a, const Place& b) {
            const int i = sections_.of(a.along), k = sections_.of(b.along);
            return i != k ? i < k : a.across < b.across;
        };
        std::sort(sorted.begin(), sorted.end(), order);
        constexpr double kBridge_mm = 6;
        const double bridge = std::max(kBridge_mm, 3 * shape_.across_spacing_mm);
        double area = 0;
        for (std::size_t at = 0; at < sorted.size();) {
            const int i = sections_.of(sorted[at].along);
            const std::size_t first = at;
            double covered = shape_.across_spacing_mm;
            for (++at; at < sorted.size() && sections_.of(sorted[at].along) == i; ++at) {
                const double gap = double(sorted[at].across) - double(sorted[at - 1].across);
                covered += gap > bridge ? shape_.across_spacing_mm : gap;
            }
            const double chord =
                double(sorted[at - 1].across) - double(sorted[first].across) + shape_.across_spacing_mm;
            const double slope = profile.slope + 2 * profile.bend * sections_.along(i);
            const bool outer = i == 0 || i == sections_.count - 1; // half a cell lies beyond the centres
            const double step_mm = sections_.step + (outer ? shape_.along_spacing_mm / 2 : 0);
            area += covered * across_mm(i) / chord * step_mm * std::sqrt(1 + slope * slope);
        }
        return area;
    }

    double off_at(double along) const
    {
        double sum = 0;
        int count = 0;
        for (const Place& place : places_)
            if (std::fabs(place.along - along) < 2 * shape_.along_spacing_mm) {
                sum += place.off;
                ++count;
            }
        return count ? sum / count : 0;
    }

private:
    const Section& section(int i) const { return sections_.all[static_cast<std::size_t>(i)]; }

    static double extended(const Sample& near, const Sample& far, double at)
    {
        return near.value + (near.value - far.value) / (near.at - far.at) * (at - near.at);
    }

    /// Across, of the cells of an end.
    double middle_at(double along) const
    {
        double sum = 0;
        int count = 0;
        for (const Place& place : places_)
            if (std::fabs(place.along - along) <= 1.5 * shape_.along_spacing_mm) {
                sum += place.across;
                ++count;
            }
        return sum / count;
    }

    bool two_lobes_beyond(double ends, double side) const
    {
        const double extent = sections_.step * sections_.count;
        const double deep = std::max(0.04 * extent, 2 * shape_.along_spacing_mm);
        int left = 0, right = 0;
        for (const Place& place : places_)
            if (side * (place.along - ends) > deep)
                ++(place.across < midrib_(place.along) ? left : right);
        constexpr int kLobe = 6; // cells
        return left >= kLobe && right >= kLobe;
    }

    /// Over the surface, through the mean heights of a dozen pieces of the section and its neighbours.
    double across_mm(int i) const
    {
        constexpr int kPieces = 12;
        std::array<Sample, kPieces> pieces{};
        const Section& here = section(i);
        const double piece_mm = std::max(1e-6, here.width() / kPieces);
        for (const Place& place : places_) {
            if (std::fabs(place.along - sections_.along(i)) > 1.5 * sections_.step || place.across < here.least ||
                place.across > here.most)
                continue;
            const auto k = static_cast<std::size_t>(
                std::min(static_cast<int>((place.across - here.least) / piece_mm), kPieces - 1));
            pieces[k].at += place.across;
            pieces[k].value += place.off;
            pieces[k].weight += 1;
        }
        std::size_t count = 0;
        for (const Sample& piece : pieces)
            if (piece.weight > 0)
                pieces[count++] = {piece.at / piece.weight, piece.value / piece.weight, piece.weight};
        if (count < 2)
            return here.width() + shape_.across_spacing_mm;
        const double half = shape_.across_spacing_mm / 2;
        double at = here.least - half, off = extended(pieces[0], pieces[1], at), way = 0;
        const auto go = [&](double w, double h) {
            way += std::sqrt((w - at) * (w - at) + (h - off) * (h - off));
            at = w;
            off = h;
        };
        for (std::size_t k = 0; k < count; ++k)
            go(pieces[k].at, pieces[k].value);
        go(here.most + half, extended(pieces[count - 1], pieces[count - 2], here.most + half));
        return way;
    }

    const LeafShape& shape_;
    std::span<const Place> places_;
    Sections sections_;
    Parabola midrib_;
    double widest_;
};

void lay_out(const LeafFrame& frame, std::span<const SurfaceCell> cells, std::span<Place> places)
{
    for (std::size_t i = 0; i < cells.size(); ++i)
        places[i] = frame.place(where(cells[i]));
}

/// Turns `along` onto the line through the middles of the sections.
void straighten(LeafFrame& frame, const Parabola& midrib)
{
    constexpr double kMost = 0.4; // 22 degrees
    const double slope = std::clamp(midrib.slope, -kMost, kMost);
    const Vec3 along = unit(frame.along + slope * frame.across);
    frame.across = unit(frame.across - slope * frame.along);
    frame.along = along;
}

/// Principal axes, turned until the middles of the sections run along the first.
LeafFrame frame_of(std::span<const SurfaceCell> cells, double focal_px, std::span<Place> places)
{
    Moments moments;
    for (const SurfaceCell& cell : cells)
        moments.add(where(cell), cell.area_mm2);
    const PrincipalAxes axes = principal_axes(moments);
    LeafFrame frame{moments.mean(), axes.axis[0], axes.axis[1], cross(axes.axis[0], axes.axis[1])};
    for (int turn = 0; turn < 2; ++turn) {
        lay_out(frame, cells, places);
        straighten(frame, midrib_of(sections_of(places, spacing_mm(frame.centre, frame.along, focal_px))));
    }
    lay_out(frame, cells, places);
    return frame;
}

/// What stands off one smooth blade is of something else, or smeared between two depths at an edge; it goes last.
/// Returns how many stay.
std::size_t drop_strays(const LeafFrame& frame, std::span<SurfaceCell> cells)
{
    constexpr double kStray_mm = 8, kStraySds = 3, kUnit_mm = 50;
    QuadricSums sums;
    const auto each = [&](const SurfaceCell& cell, const auto& use) {
        const Place place = frame.place(where(cell));
        return use(double{place.along} / kUnit_mm, double{place.across} / kUnit_mm, double{place.off});
    };
    for (const SurfaceCell& cell : cells)
        each(cell, [&](double x, double y, double off) { sums.add(x, y, off); });
    const Quadric blade = sums.surface();
    const double limit = std::max(kStray_mm, kStraySds * std::sqrt(sums.leftover() / sums.count()));
    const auto rest = std::partition(cells.begin(), cells.end(), [&](const SurfaceCell& cell) {
        return each(cell, [&](double x, double y, double off) { return std::fabs(off - blade(x, y)) <= limit; });
    });
    return static_cast<std::size_t>(rest - cells.begin());
}

/// From the widest section outwards to where the blade has run out.
struct BladeRange
{
    double from, to;

    bool holds(const Place& place) const { return place.along >= from && place.along <= to; }
};

BladeRange blade_of(const Sections& sections)
{
    // Narrower than this is a petiole, or the last of the tip; the tip goes on as it tapers from kTapering to there.
    constexpr double kNarrow = 0.2, kTapering = 0.4;
    int widest = 0;
    for (int i = 1; i < sections.count; ++i)
        if (sections.all[static_cast<std::size_t>(i)].width() > sections.all[static_cast<std::size_t>(widest)].width())
            widest = i;
    const double most = sections.all[static_cast<std::size_t>(widest)].width();
    const auto reach = [&](int side) {
        int tapering = widest;
        for (int i = widest; i >= 0 && i < sections.count; i += side) {
            const Section& section = sections.all[static_cast<std::size_t>(i)];
            if (section.cells == 0)
                continue;
            if (section.width() >= kTapering * most)
                tapering = i;
            if (section.width() < kNarrow * most) {
                const double taper = std::abs(i - tapering) * kNarrow / (kTapering - kNarrow);
                return sections.along(i) + side * (taper - 0.5) * sections.step;
            }
        }
        constexpr double kEnd_mm = 1e9;
        return side * kEnd_mm;
    };
    return {reach(-1), reach(+1)};
}

} // namespace

LeafShape leaf_shape(std::span<SurfaceCell> cells, double focal_px, std::span<Place> places)
{
    LeafShape shape;
    LeafFrame& frame = shape.frame;
    frame = frame_of(cells, focal_px, places);
    for (int pass = 0; pass < 3; ++pass) { // each time the others tell better
        const std::size_t count = drop_strays(frame, cells);
        if (count == cells.size() || count < kFewestCells)
            break;
        cells = cells.first(count);
        places = places.first(count);
        frame = frame_of(cells, focal_px, places);
    }
    for (int pass = 0; pass < 2; ++pass) { // a petiole turns the frame
        const BladeRange blade = blade_of(sections_of(places, spacing_mm(frame.centre, frame.along, focal_px)));
        const auto rest = std::partition(
            cells.begin(), cells.end(), [&](const SurfaceCell& cell) { return blade.holds(frame.place(where(cell))); });
        const auto count = static_cast<std::size_t>(rest - cells.begin());
        // A petiole is a small part of what is seen of a leaf; a large one is another leaf.
        constexpr double kPetioleShare = 0.35;
        if (count == cells.size() || count < kFewestCells ||
            static_cast<double>(count) < (1 - kPetioleShare) * static_cast<double>(cells.size()))
            break;
        cells = cells.first(count);
        places = places.first(count);
        frame = frame_of(cells, focal_px, places);
    }
    shape.blade_cells = cells.size();
    shape.along_spacing_mm = spacing_mm(frame.centre, frame.along, focal_px);
    shape.across_spacing_mm = spacing_mm(frame.centre, frame.across, focal_px);

    const Measure measure(shape, places);
    const MidribEnd ends[2] = {measure.end(-1), measure.end(+1)};
    Parabola profile;
    double noise_mm = 0;
    shape.length_mm = measure.length_mm(ends[0], ends[1], profile, noise_mm) + shape.along_spacing_mm;
    shape.width_mm = measure.width_mm();
    shape.area_mm2 = measure.area_mm2(places, profile);
    const double slope = profile.slope + profile.bend * (ends[0].along + ends[1].along);
    const double stretch = std::sqrt(1 + slope * slope);
    shape.curvature_per_mm = 2 * profile.bend / (stretch * stretch * stretch);
    // Of a parabola through n equal samples over L: sd of its bend = sqrt(180 / n) sd / L^2.
    shape.curvature_sd_per_mm = 2 * std::sqrt(180.0 / 16) * noise_mm / (shape.length_mm * shape.length_mm);
    for (std::size_t i = 0; i < 2; ++i)
        shape.ends[i] = {frame.point(ends[i].along, ends[i].across, measure.off_at(ends[i].along)), ends[i].sinus};
    return shape;
}

} // namespace dicot
