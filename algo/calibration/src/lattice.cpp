#include "lattice.h"

#include "crossing.h"
#include "neighbourhood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <optional>

namespace dicot::calibration {

namespace {

constexpr double kAlongEdge = 0.960;     // cosine between an edge and the next crossing on it
constexpr double kSameEdge = 0.930;      // cosine between a link and the axis of the crossing at its end
constexpr double kNearPrediction = 0.28; // of the spacing
constexpr double kEdgeContrast = 0.2;    // of the weaker crossing's contrast
constexpr double kWeakContrast = 4;      // grey levels, where the lattice says that a crossing must be
constexpr double kMinSpacing_px = 4;
constexpr std::size_t kSureNodes = 9;    // from which on a lattice's word is taken for a weak crossing
constexpr double kBend = 0.12;           // of a step, between a corner and the middle of its neighbours
constexpr double kStraightShare = 0.7;   // of the corners of a true board bend less
constexpr int kTries = 12;               // crossings looked at, nearest first, before an edge counts as ended
constexpr double kSettledContrast = 0.5; // of a whole board's contrast, below which no better board is looked for

constexpr std::array<Cell, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

Cell beyond(Cell cell, Cell step, int times = 1)
{
    return {cell.i + times * step.i, cell.j + times * step.j};
}

class Growth
{
public:
    Growth(const GreyLevel& level, const std::vector<Saddle>& saddles, const Neighbourhood& near,
           std::vector<bool>& taken, int max_side)
        : level_(level), saddles_(saddles), near_(near), taken_(taken), max_side_(max_side)
    {
    }

    Lattice from(std::size_t seed)
    {
        const Saddle& first = saddles_[seed];
        place({0, 0}, {first.at, first.a, first.b, true, first.contrast});
        taken_[seed] = true;
        follow_edges();
        while (nodes_.size() >= 4 && lies_straight(nodes_) && fill_predicted())
            follow_edges();
        return std::move(nodes_);
    }

private:
    void place(Cell cell, const Node& node)
    {
        nodes_[cell] = node;
        fresh_.push_back(cell);
    }

    bool within_reach(Cell cell) const
    {
        const Extent e = extent_of(nodes_);
        return std::max(e.i1, cell.i) - std::min(e.i0, cell.i) < max_side_ &&
               std::max(e.j1, cell.j) - std::min(e.j0, cell.j) < max_side_;
    }

    static Point2 direction(const Node& node, Cell step)
    {
        return step.i != 0 ? static_cast<double>(step.i) * node.u : static_cast<double>(step.j) * node.v;
    }

    /// Which side of a link is bright: a vector pointing to it.
    static Point2 bright_side(const Node& node, Cell step)
    {
        const double sign = (step.i + step.j) * (node.bright ? 1.0 : -1.0);
        return sign * (step.i != 0 ? node.v : node.u);
    }

    /// The saddle as the node that a step from `from` leads to, its axes signed like those of `from`; nothing when its
    /// colours do not alternate with those of `from`.
    static std::optional<Node> as_node(const Saddle& saddle, const Node& from, Cell step)
    {
        Node node{saddle.at, {}, {}, !from.bright, saddle.contrast};
        node.u = node.bright ? saddle.a : saddle.b;
        node.v = node.bright ? saddle.b : saddle.a;
        if (dot(node.u, from.u) < 0)
            node.u = -1.0 * node.u;
        if (dot(node.v, from.v) < 0)
            node.v = -1.0 * node.v;
        if (cross(node.u, node.v) <= 0)
            return std::nullopt;
        const Point2 link = unit(saddle.at - from.at);
        if (dot(link, direction(node, step)) < kSameEdge)
            return std::nullopt;
        return node;
    }

    bool edge_between(const Node& from, const Node& to, Point2 bright_side) const
    {
        const Point2 link = to.at - from.at;
        const double size = length(link);
        Point2 normal{-link.y / size, link.x / size};
        if (dot(normal, bright_side) < 0)
            normal = -1.0 * normal;
        const double off_px = std::clamp(0.2 * size, 1.5, 4.0);
        const double needed = kEdgeContrast * std::min(from.contrast, to.contrast);
        for (const double share : {0.2, 0.35, 0.5, 0.65, 0.8}) {
            const Point2 middle = from.at + share * link;
            const Point2 bright = middle + off_px * normal;
            const Point2 dark = middle - off_px * normal;
            if (level_.sample(bright.x, bright.y) - level_.sample(dark.x, dark.y) < needed)
                return false;
        }
        return true;
    }

    void follow_edges()
    {
        while (!fresh_.empty()) {
            const Cell cell = fresh_.front();
            fresh_.pop_front();
            for (const Cell step : kSteps) {
                const Cell next = beyond(cell, step);
                if (!nodes_.contains(next) && within_reach(next))
                    take_step(cell, step, next);
            }
        }
    }

    void take_step(Cell cell, Cell step, Cell next)
    {
        const Node& from = nodes_.at(cell);
        double shortest = kMinSpacing_px;
        double longest = 1e9;
        if (const auto behind = nodes_.find(beyond(cell, step, -1)); behind != nodes_.end()) {
            const double spacing = length(from.at - behind->second.at);
            shortest = 0.5 * spacing;
            longest = 1.8 * spacing;
        }
        std::optional<Node> best;
        std::size_t best_saddle = 0;
        int tries = 0;
        const Point2 ahead = direction(from, step);
        near_.outwards_from(
            from.at, [&](double distance) { return distance < longest && tries < kTries; },
            [&](std::size_t k) {
                const Point2 link = saddles_[k].at - from.at;
                const double size = length(link);
                if (taken_[k] || size < shortest || size > longest || dot(link, ahead) < kAlongEdge * size)
                    return;
                ++tries;
                const std::optional<Node> node = as_node(saddles_[k], from, step);
                if (!node || !edge_between(from, *node, bright_side(from, step)))
                    return;
                best = node;
                best_saddle = k;
                longest = size;
            });
        if (best) {
            taken_[best_saddle] = true;
            place(next, *best);
        }
    }

    const Node* find(Cell cell) const
    {
        const auto found = nodes_.find(cell);
        return found == nodes_.end() ? nullptr : &found->second;
    }

    struct Prediction
    {
        Point2 at;
        const Node* neighbour;
        Cell step; // from the neighbour to the predicted place
        double spacing_px;
    };

    /// Where the neighbours put `cell`: the mean of the straight continuations and of the parallelograms.
    std::optional<Prediction> predict(Cell cell) const
    {
        Point2 sum{};
        int votes = 0;
        Prediction best{};
        best.spacing_px = 1e9;
        for (const Cell step : kSteps) {
            const Node* const near = find(beyond(cell, step, -1));
            if (!near)
                continue;
            const auto vote = [&](Point2 link) {
                sum = sum + near->at + link;
                ++votes;
                if (length(link) < best.spacing_px)
                    best = {{}, near, step, length(link)};
            };
            if (const Node* const far = find(beyond(cell, step, -2)))
                vote(near->at - far->at);
            for (const Cell side : {Cell{step.j, step.i}, Cell{-step.j, -step.i}}) {
                const Node* const beside = find(beyond(cell, side));
                const Node* const corner = find(beyond(beyond(cell, side), step, -1));
                if (beside && corner)
                    vote(beside->at - corner->at);
            }
        }
        if (votes == 0 || best.spacing_px < kMinSpacing_px)
            return std::nullopt;
        best.at = (1.0 / votes) * sum;
        return best;
    }

    /// Adds one crossing where the lattice says that one must be, even a weak one; false when there is none to add.
    bool fill_predicted()
    {
        std::vector<Cell> open;
        for (const auto& [cell, node] : nodes_)
            for (const Cell step : kSteps)
                if (const Cell next = beyond(cell, step); !nodes_.contains(next) && within_reach(next))
                    open.push_back(next);
        std::sort(open.begin(), open.end());
        open.erase(std::unique(open.begin(), open.end()), open.end());
        bool added = false;
        for (const Cell cell : open) {
            if (given_up_.contains(cell) && given_up_.at(cell) == nodes_.size())
                continue;
            const std::optional<Prediction> where = predict(cell);
            if (where && within_reach(cell) && fill(cell, *where))
                added = true;
            else
                given_up_[cell] = nodes_.size();
        }
        return added;
    }

    /// Crossings of the lattice on three sides or four: a board has no holes.
    bool surrounded(Cell cell) const
    {
        return std::ranges::count_if(kSteps, [&](Cell step) { return find(beyond(cell, step)) != nullptr; }) >= 3;
    }

    bool fill(Cell cell, const Prediction& where)
    {
        const Node& from = *where.neighbour;
        for (std::size_t k = 0; k < saddles_.size(); ++k) {
            if (taken_[k] || length(saddles_[k].at - where.at) > kNearPrediction * where.spacing_px)
                continue;
            const std::optional<Node> node = as_node(saddles_[k], from, where.step);
            if (!node || !edge_between(from, *node, bright_side(from, where.step)))
                continue;
            taken_[k] = true;
            place(cell, *node);
            return true;
        }
        if (nodes_.size() < kSureNodes)
            return false;
        const double reach = std::max(0.35 * where.spacing_px, 2.5);
        const std::optional<Point2> at =
            refine_crossing(level_, where.at, reach * from.u, reach * from.v, kNearPrediction * where.spacing_px);
        if (!at)
            return false;
        if (surrounded(cell)) { // whatever light falls on it
            const Node& alike = *find(beyond(cell, where.step, -1));
            place(cell, {*at, alike.u, alike.v, !alike.bright, alike.contrast});
            return true;
        }
        for (const double share : {0.3, 0.2, 0.42}) {
            const std::optional<Saddle> saddle = read_saddle(level_, *at, share * where.spacing_px, kWeakContrast);
            if (!saddle)
                continue;
            const std::optional<Node> node = as_node(*saddle, from, where.step);
            if (!node || !edge_between(from, *node, bright_side(from, where.step)))
                continue;
            place(cell, *node);
            return true;
        }
        return false;
    }

    const GreyLevel& level_;
    const std::vector<Saddle>& saddles_;
    const Neighbourhood& near_;
    std::vector<bool>& taken_;
    int max_side_;
    Lattice nodes_;
    std::deque<Cell> fresh_;
    std::map<Cell, std::size_t> given_up_; // with the lattice's size at that time
};

} // namespace

Extent extent_of(const Lattice& lattice)
{
    Extent e;
    bool first = true;
    for (const auto& [cell, node] : lattice) {
        e.i0 = first ? cell.i : std::min(e.i0, cell.i);
        e.i1 = first ? cell.i : std::max(e.i1, cell.i);
        e.j0 = first ? cell.j : std::min(e.j0, cell.j);
        e.j1 = first ? cell.j : std::max(e.j1, cell.j);
        first = false;
    }
    return e;
}

bool lies_straight(const Lattice& lattice)
{
    int straight = 0;
    int all = 0;
    for (const auto& [cell, node] : lattice)
        for (const Cell step : {Cell{1, 0}, Cell{0, 1}}) {
            const auto before = lattice.find({cell.i - step.i, cell.j - step.j});
            const auto after = lattice.find({cell.i + step.i, cell.j + step.j});
            if (before == lattice.end() || after == lattice.end())
                continue;
            const Point2 bend = 0.5 * (before->second.at + after->second.at) - node.at;
            straight += length(bend) < kBend * 0.5 * length(after->second.at - before->second.at) ? 1 : 0;
            ++all;
        }
    return straight >= kStraightShare * all;
}

std::vector<Lattice> grow_lattices(const GreyLevel& level, const std::vector<Saddle>& saddles, std::size_t whole_nodes,
                                   int max_side)
{
    constexpr std::size_t kMinNodes = 4;
    const Neighbourhood near(level, saddles);
    std::vector<Lattice> lattices;
    std::vector<bool> taken(saddles.size(), false);
    double settled_contrast = 0;
    for (std::size_t seed = 0; seed < saddles.size(); ++seed) {
        if (taken[seed] || saddles[seed].contrast < settled_contrast)
            continue;
        std::vector<bool> before = taken;
        Lattice lattice = Growth(level, saddles, near, taken, max_side).from(seed);
        if (lattice.size() >= whole_nodes)
            settled_contrast = std::max(settled_contrast, kSettledContrast * saddles[seed].contrast);
        if (lattice.size() >= kMinNodes && lies_straight(lattice))
            lattices.push_back(std::move(lattice));
        else
            taken = std::move(before); // a bad seed must not take crossings from a good one
    }
    std::stable_sort(lattices.begin(), lattices.end(),
                     [](const Lattice& p, const Lattice& q) { return p.size() > q.size(); });
    return lattices;
}

} // namespace dicot::calibration
