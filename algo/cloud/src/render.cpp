#include "dicot/cloud/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace dicot {
namespace {

constexpr int kFiner = 2; // drawn this much finer and averaged, each way
constexpr std::size_t kSamples = 8192;
constexpr double kMargin = 0.94;
constexpr double kOverlap = 2.2; // splats overlap, or slanted leaves show the background through
constexpr double kWidestSplat = 24;
constexpr double kEdgeStrength = 90;
constexpr int kEdgeReach = 2;
constexpr Rgb8 kBackground{226, 229, 232};

struct Vec3
{
    double x, y, z;
};

/// What lies in the scratch arena: the finer picture, its depths, and a sample of the cloud.
struct Canvas
{
    int width;
    int height;
    std::span<Rgb8> colour;
    std::span<float> depth;
    std::span<float> sample;

    Canvas(Arena& arena, int w, int h) : width(w * kFiner), height(h * kFiner)
    {
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        colour = arena.take<Rgb8>(pixels);
        depth = arena.take<float>(pixels);
        sample = arena.take<float>(kSamples);
    }
    std::size_t index(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

Vec3 position_of(const CloudPoint& point)
{
    return {static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z)};
}

/// The value that `fraction` of an even sample of the points lie below: 0.5 is the median.
template <typename Value>
double percentile(const PointCloud& cloud, std::span<float> room, double fraction, Value value)
{
    const std::size_t count = std::min(cloud.points.size(), room.size());
    for (std::size_t i = 0; i < count; ++i)
        room[i] = static_cast<float>(value(cloud.points[i * cloud.points.size() / count]));
    const auto middle = room.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(count - 1));
    std::nth_element(room.begin(), middle, room.begin() + static_cast<std::ptrdiff_t>(count));
    return static_cast<double>(*middle);
}

/// From the cloud's frame to the viewer's: x right, y down, z the depth.
class View
{
public:
    View(const PointCloud& cloud, const Viewpoint& from, const Canvas& canvas)
    {
        constexpr double kRadians = 3.14159265358979323846 / 180;
        cos_yaw_ = std::cos(from.yaw_deg * kRadians);
        sin_yaw_ = std::sin(from.yaw_deg * kRadians);
        cos_pitch_ = std::cos(from.pitch_deg * kRadians);
        sin_pitch_ = std::sin(from.pitch_deg * kRadians);
        pivot_ = {percentile(cloud, canvas.sample, 0.5, [](const CloudPoint& p) { return p.x; }),
                  percentile(cloud, canvas.sample, 0.5, [](const CloudPoint& p) { return p.y; }),
                  percentile(cloud, canvas.sample, 0.5, [](const CloudPoint& p) { return p.z; })};
        distance_ = pivot_.z;
        frame(cloud, canvas);
    }

    Vec3 turned(const CloudPoint& point) const
    {
        const Vec3 at = position_of(point);
        const double x = at.x - pivot_.x;
        const double y = at.y - pivot_.y;
        const double z = at.z - pivot_.z;
        const double across = cos_yaw_ * x + sin_yaw_ * z;
        const double along = cos_yaw_ * z - sin_yaw_ * x;
        return {across, cos_pitch_ * y - sin_pitch_ * along, sin_pitch_ * y + cos_pitch_ * along + distance_};
    }
    bool visible(const Vec3& at) const { return at.z > distance_ / 8; }
    double column(const Vec3& at) const { return zero_x_ + scale_ * at.x / at.z; }
    double row(const Vec3& at) const { return zero_y_ + scale_ * at.y / at.z; }
    double scale() const { return scale_; }

private:
    void frame(const PointCloud& cloud, const Canvas& canvas)
    {
        const auto slope = [&](double fraction, auto side) {
            return percentile(cloud, canvas.sample, fraction, [&](const CloudPoint& point) {
                const Vec3 at = turned(point);
                return visible(at) ? side(at) / at.z : 0.0;
            });
        };
        const auto across = [](const Vec3& at) { return at.x; };
        const auto down = [](const Vec3& at) { return at.y; };
        const double left = slope(0.01, across);
        const double right = slope(0.99, across);
        const double top = slope(0.01, down);
        const double bottom = slope(0.99, down);
        scale_ = kMargin *
                 std::min(canvas.width / std::max(right - left, 1e-6), canvas.height / std::max(bottom - top, 1e-6));
        zero_x_ = canvas.width / 2.0 - scale_ * (left + right) / 2;
        zero_y_ = canvas.height / 2.0 - scale_ * (top + bottom) / 2;
    }

    double cos_yaw_ = 1, sin_yaw_ = 0, cos_pitch_ = 1, sin_pitch_ = 0;
    Vec3 pivot_{};
    double distance_ = 1;
    double scale_ = 1, zero_x_ = 0, zero_y_ = 0;
};

void splat(const Canvas& canvas, double column, double row, double side, float depth, Rgb8 colour)
{
    const int x0 = std::max(0, static_cast<int>(std::lround(column - side / 2)));
    const int y0 = std::max(0, static_cast<int>(std::lround(row - side / 2)));
    const int x1 = std::min<int>(canvas.width, static_cast<int>(std::lround(column + side / 2)));
    const int y1 = std::min<int>(canvas.height, static_cast<int>(std::lround(row + side / 2)));
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
            if (const std::size_t i = canvas.index(x, y); depth < canvas.depth[i]) {
                canvas.depth[i] = depth;
                canvas.colour[i] = colour;
            }
}

/// Eye-dome lighting (C. Boucheny, 2009): darker where neighbours stand in front.
double light_at(const Canvas& canvas, int x, int y)
{
    const float depth = canvas.depth[canvas.index(x, y)];
    double in_front = 0;
    for (int dy = -kEdgeReach; dy <= kEdgeReach; dy += kEdgeReach)
        for (int dx = -kEdgeReach; dx <= kEdgeReach; dx += kEdgeReach) {
            const int nx = std::clamp(x + dx, 0, canvas.width - 1);
            const int ny = std::clamp(y + dy, 0, canvas.height - 1);
            const double nearer = 1 - static_cast<double>(canvas.depth[canvas.index(nx, ny)] / depth);
            in_front += std::clamp(nearer, 0.0, 0.05);
        }
    return std::exp(-kEdgeStrength * in_front / 8 * 0.25);
}

Rgb8 averaged(const Canvas& canvas, int x, int y)
{
    double sum[3] = {};
    for (int fy = 0; fy < kFiner; ++fy)
        for (int fx = 0; fx < kFiner; ++fx) {
            const std::size_t i = canvas.index(x * kFiner + fx, y * kFiner + fy);
            const bool empty = canvas.depth[i] == std::numeric_limits<float>::max();
            const double light = empty ? 1.0 : light_at(canvas, x * kFiner + fx, y * kFiner + fy);
            const Rgb8 colour = empty ? kBackground : canvas.colour[i];
            sum[0] += light * colour.r;
            sum[1] += light * colour.g;
            sum[2] += light * colour.b;
        }
    const auto channel = [](double total) { return static_cast<std::uint8_t>(total / (kFiner * kFiner) + 0.5); };
    return {channel(sum[0]), channel(sum[1]), channel(sum[2])};
}

} // namespace

void lay_out_render(Arena& arena, int width, int height)
{
    const Canvas canvas{arena, width, height};
}

void render_cloud(const PointCloud& cloud, double focal_px, const Viewpoint& from, ImageView<Rgb8> into, Arena& scratch)
{
    const std::size_t mark = scratch.used();
    const Canvas canvas{scratch, into.width, into.height};
    scratch.rewind(mark);
    if (canvas.sample.empty())
        return;
    std::fill(canvas.depth.begin(), canvas.depth.end(), std::numeric_limits<float>::max());
    if (!cloud.points.empty()) {
        const View view{cloud, from, canvas};
        for (const CloudPoint& point : cloud.points) {
            const Vec3 at = view.turned(point);
            if (!view.visible(at))
                continue;
            const double side = std::clamp(kOverlap * view.scale() * (point.z / focal_px) / at.z, 1.0, kWidestSplat);
            const double column = view.column(at);
            const double row = view.row(at);
            if (std::fabs(column) < 1e6 && std::fabs(row) < 1e6)
                splat(canvas, column, row, side, static_cast<float>(at.z), point.colour);
        }
    }
    for (int y = 0; y < into.height; ++y)
        for (int x = 0; x < into.width; ++x)
            into.at(x, y) = averaged(canvas, x, y);
}

void render_two_views(const PointCloud& cloud, double focal_px, ImageView<Rgb8> into, Arena& scratch)
{
    const int half = into.width / 2;
    render_cloud(cloud, focal_px, {-14, 4}, {into.data, half, into.height, into.stride}, scratch);
    render_cloud(cloud, focal_px, {30, 18}, {into.data + half, into.width - half, into.height, into.stride}, scratch);
}

} // namespace dicot
