#include "dicot/plant/convex_hull.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace dicot {
namespace {

struct Face
{
    std::int32_t corner[3]; ///< counter-clockwise from outside
    bool alive;
};

struct Edge
{
    std::int32_t from, to;
};

struct Memory
{
    std::span<Face> faces;
    std::span<Edge> rim;
};

/// A hull of n points has at most 2 n - 4 faces; faces that died make room again.
Memory lay_out(std::size_t points, Arena& arena)
{
    return {arena.take<Face>(2 * points + 4), arena.take<Edge>(3 * points + 6)};
}

/// Six times the signed volume of a tetrahedron: positive when d lies beyond the face a, b, c.
std::int64_t beyond(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d)
{
    const std::int64_t bx = b.x - a.x, by = b.y - a.y, bz = b.z - a.z;
    const std::int64_t cx = c.x - a.x, cy = c.y - a.y, cz = c.z - a.z;
    const std::int64_t dx = d.x - a.x, dy = d.y - a.y, dz = d.z - a.z;
    return dx * (by * cz - bz * cy) + dy * (bz * cx - bx * cz) + dz * (bx * cy - by * cx);
}

bool in_line(const GridPoint& a, const GridPoint& b, const GridPoint& c)
{
    const std::int64_t bx = b.x - a.x, by = b.y - a.y, bz = b.z - a.z;
    const std::int64_t cx = c.x - a.x, cy = c.y - a.y, cz = c.z - a.z;
    return by * cz == bz * cy && bz * cx == bx * cz && bx * cy == by * cx;
}

class Hull
{
public:
    Hull(std::span<const GridPoint> points, Memory memory) : points_(points), memory_(memory) {}

    /// Four points that span space; false when there are none.
    bool begin()
    {
        const auto n = static_cast<std::int32_t>(points_.size());
        std::int32_t b = 1;
        while (b < n && same(0, b))
            ++b;
        std::int32_t c = b + 1;
        while (c < n && in_line(at(0), at(b), at(c)))
            ++c;
        std::int32_t d = c + 1;
        while (d < n && beyond(at(0), at(b), at(c), at(d)) == 0)
            ++d;
        if (d >= n)
            return false;
        if (beyond(at(0), at(b), at(c), at(d)) > 0)
            std::swap(b, c);
        add(0, b, c);
        add(0, c, d);
        add(c, b, d);
        add(b, 0, d);
        return true;
    }

    void take_in(std::int32_t p)
    {
        std::size_t rim = 0;
        for (std::size_t f = 0; f < count_; ++f) {
            Face& face = memory_.faces[f];
            if (!face.alive || beyond(at(face.corner[0]), at(face.corner[1]), at(face.corner[2]), at(p)) <= 0)
                continue;
            face.alive = false;
            for (std::size_t k = 0; k < 3; ++k)
                rim = cross_out({face.corner[k], face.corner[(k + 1) % 3]}, rim);
        }
        free_ = 0; // faces that died are used again
        for (std::size_t e = 0; e < rim; ++e)
            add(memory_.rim[e].from, memory_.rim[e].to, p);
    }

    std::int64_t volume_x6() const
    {
        std::int64_t sum = 0;
        for (const Face& face : memory_.faces.first(count_))
            if (face.alive)
                sum -= beyond(at(face.corner[0]), at(face.corner[1]), at(face.corner[2]), at(0));
        return sum;
    }

private:
    const GridPoint& at(std::int32_t i) const { return points_[static_cast<std::size_t>(i)]; }
    bool same(std::int32_t i, std::int32_t j) const
    {
        return at(i).x == at(j).x && at(i).y == at(j).y && at(i).z == at(j).z;
    }

    /// Edges that two dying faces share vanish; the rest is the rim.
    std::size_t cross_out(Edge edge, std::size_t rim)
    {
        for (std::size_t e = 0; e < rim; ++e)
            if (memory_.rim[e].from == edge.to && memory_.rim[e].to == edge.from) {
                memory_.rim[e] = memory_.rim[rim - 1];
                return rim - 1;
            }
        memory_.rim[rim] = edge;
        return rim + 1;
    }

    void add(std::int32_t a, std::int32_t b, std::int32_t c)
    {
        while (free_ < count_ && memory_.faces[free_].alive)
            ++free_;
        if (free_ == count_)
            ++count_;
        memory_.faces[free_] = {{a, b, c}, true};
    }

    std::span<const GridPoint> points_;
    Memory memory_;
    std::size_t count_ = 0;
    std::size_t free_ = 0;
};

} // namespace

std::size_t hull_bytes(std::size_t points)
{
    Arena measure;
    (void)lay_out(points, measure);
    return measure.peak();
}

std::int64_t hull_volume_x6(std::span<const GridPoint> points, Arena& arena)
{
    const std::size_t mark = arena.used();
    const Memory memory = lay_out(points.size(), arena);
    if (arena.overrun())
        return -1;
    Hull hull(points, memory);
    std::int64_t volume = 0;
    if (points.size() >= 4 && hull.begin()) {
        for (std::int32_t i = 1; i < static_cast<std::int32_t>(points.size()); ++i)
            hull.take_in(i);
        volume = hull.volume_x6();
    }
    arena.rewind(mark);
    return volume;
}

} // namespace dicot
