#include "leaf_scene.h"

#include "calibration_data.h"
#include "csv_numbers.h"
#include "matched.h"
#include "own_rig.h"
#include "plant_pairs.h"

#include "dicot/cloud/triangulate.h"
#include "dicot/picture/read_map.h"

#include <cmath>
#include <map>

namespace dicot::test {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;

Point3 minus(const Point3& a, const Point3& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

Point3 crossed(const Point3& a, const Point3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double dotted(const Point3& a, const Point3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

std::vector<int> ids_of(const std::string& path)
{
    const auto head = map_head(path.c_str());
    const PictureSize size = head.value().size;
    std::vector<float> values(static_cast<std::size_t>(size.pixels()));
    EXPECT_TRUE(read_map(path.c_str(), 1, {values.data(), size.width, size.height}).ok());
    std::vector<int> ids;
    for (const float value : values)
        ids.push_back(std::isfinite(value) ? static_cast<int>(value) : 0);
    return ids;
}

/// The true surface: where each pixel's ray ends, in the left camera's frame.
class Surface
{
public:
    Surface(const TrueDepth& depth, const std::vector<int>& leaf) : depth_(depth), leaf_(leaf)
    {
        const StereoRig rig = rig_dev_truth();
        for (int y = 0; y < depth.height; ++y)
            for (int x = 0; x < depth.width; ++x) {
                const auto ray = undistort(rig.left, {double(x), double(y)});
                const double z = static_cast<double>(depth.mm[index(x, y)]);
                at_.push_back(ray ? Point3{ray->x * z, ray->y * z, z} : Point3{});
            }
    }
    const Point3& at(std::size_t i) const { return at_[i]; }
    std::size_t index(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(depth_.width) + static_cast<std::size_t>(x);
    }
    /// Between the middles of a pixel's neighbours of the same leaf.
    double area_mm2(int x, int y) const
    {
        const Point3 across = step(x, y, 1, 0), down = step(x, y, 0, 1);
        const Point3 area = crossed(across, down);
        return std::sqrt(dotted(area, area));
    }

private:
    Point3 step(int x, int y, int dx, int dy) const
    {
        Point3 sum;
        int count = 0;
        for (const int side : {-1, 1}) {
            const int nx = x + side * dx, ny = y + side * dy;
            if (nx < 0 || ny < 0 || nx >= depth_.width || ny >= depth_.height ||
                leaf_[index(nx, ny)] != leaf_[index(x, y)])
                continue;
            const Point3 way = minus(at_[index(nx, ny)], at_[index(x, y)]);
            constexpr double kFold_mm = 15; // the leaf behind itself
            if (std::fabs(way.z) > kFold_mm)
                continue;
            sum = {sum.x + side * way.x, sum.y + side * way.y, sum.z + side * way.z};
            ++count;
        }
        if (count == 0) { // a pixel alone faces the camera
            const double side_mm = at_[index(x, y)].z / 778.5;
            return {dx * side_mm, dy * side_mm, 0};
        }
        return {sum.x / count, sum.y / count, sum.z / count};
    }

    const TrueDepth& depth_;
    const std::vector<int>& leaf_;
    std::vector<Point3> at_;
};

/// The normal of the plane through points of unequal weight: the least eigenvector, by inverse iteration.
Point3 normal_of(const std::vector<std::pair<Point3, double>>& points)
{
    Point3 mean;
    double weight = 0;
    for (const auto& [p, w] : points) {
        mean = {mean.x + w * p.x, mean.y + w * p.y, mean.z + w * p.z};
        weight += w;
    }
    mean = {mean.x / weight, mean.y / weight, mean.z / weight};
    std::array<double, 9> c{};
    for (const auto& [p, w] : points) {
        const Point3 d = minus(p, mean);
        const double v[3] = {d.x, d.y, d.z};
        for (std::size_t i = 0; i < 9; ++i)
            c[i] += w * v[i / 3] * v[i % 3] / weight;
    }
    for (std::size_t i = 0; i < 9; i += 4)
        c[i] += 1e-6;
    // The adjugate's largest row, over and over, is the least eigenvector's direction.
    const Point3 rows[3] = {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}};
    const Point3 adjugate[3] = {crossed(rows[1], rows[2]), crossed(rows[2], rows[0]), crossed(rows[0], rows[1])};
    Point3 n{0.3, 0.5, 0.8};
    for (int i = 0; i < 50; ++i) {
        n = {dotted(adjugate[0], n), dotted(adjugate[1], n), dotted(adjugate[2], n)};
        const double size = std::sqrt(dotted(n, n));
        n = {n.x / size, n.y / size, n.z / size};
    }
    return n;
}

/// Metres of the world to mm of the rectified left camera.
GroundFrame true_ground(const nlohmann::json& about, const Turn& rectifying)
{
    const auto& pose = about["left_camera_to_world"];
    const auto axis = [&](std::size_t row) {
        const Point3 in_left{pose[row][0].get<double>(), pose[row][1].get<double>(), pose[row][2].get<double>()};
        return turned(rectifying, in_left);
    };
    const double soil_mm = about["plant_height_mm"].get<double>() - about["height_above_soil_mm"].get<double>();
    const double from[3] = {-1000 * pose[0][3].get<double>(), -1000 * pose[1][3].get<double>(),
                            soil_mm - 1000 * pose[2][3].get<double>()};
    GroundFrame ground;
    ground.kind = GroundFrame::Kind::kSoil;
    const Point3 axes[3] = {axis(0), axis(1), axis(2)};
    double(*into[3])[3] = {&ground.right, &ground.away, &ground.up};
    for (std::size_t i = 0; i < 3; ++i) {
        const double v[3] = {axes[i].x, axes[i].y, axes[i].z};
        for (std::size_t k = 0; k < 3; ++k) {
            (*into[i])[k] = v[k];
            ground.origin_mm[k] += from[i] * v[k];
        }
    }
    return ground;
}

void read_leaves(const std::string& folder, const Surface& surface, const TrueDepth& depth, const Turn& rectifying,
                 LeafScene& scene)
{
    constexpr int kSeen = 255;
    const std::vector<int> by_right = ids_of(folder + "/gt_visible_right.png");
    std::map<int, std::vector<std::pair<Point3, double>>> seen;
    for (int y = 0; y < depth.height; ++y)
        for (int x = 0; x < depth.width; ++x)
            if (const int id = scene.picture_leaf[surface.index(x, y)])
                seen[id].emplace_back(turned(rectifying, surface.at(surface.index(x, y))), surface.area_mm2(x, y));
    const auto& up = scene.ground.up;
    for (auto& row : csv_numbers(folder + "/gt_leaves.csv")) {
        const auto place = [&](const std::string& of) {
            return turned(rectifying, {row[of + "_x_mm"], row[of + "_y_mm"], row[of + "_z_mm"]});
        };
        TrueLeaf leaf{static_cast<int>(row["leaf_id"]),
                      row["length_mm"],
                      row["width_mm"],
                      row["area_mm2"],
                      place("base"),
                      place("tip"),
                      0,
                      0,
                      0,
                      0};
        const auto& cells = seen[leaf.id];
        leaf.pixels = static_cast<long>(cells.size());
        for (std::size_t i = 0; i < by_right.size(); ++i)
            leaf.by_both += scene.picture_leaf[i] == leaf.id && by_right[i] == kSeen;
        for (const auto& [point, area] : cells)
            leaf.visible_mm2 += area;
        if (leaf.pixels > 10)
            leaf.slant_deg =
                std::acos(std::min(1.0, std::fabs(dotted(normal_of(cells), {up[0], up[1], up[2]})))) * kDegrees;
        scene.visible_mm2 += leaf.visible_mm2;
        scene.leaves.push_back(leaf);
    }
}

LeafScene look_at(const std::string& plant, const std::string& light)
{
    static const RectifiedView view(own_rig());
    const std::string folder = data_path("rig-dev/plants/" + plant);
    LeafScene scene;
    scene.name = plant + " " + light;
    const scenes::Picture left = view.left(scenes::read(folder + "/" + light + "_left.jpg"));
    const scenes::Picture right = view.right(scenes::read(folder + "/" + light + "_right.jpg"));
    const Matched matched(left.view(), right.view(), view.options(MatchMethod::kBest));
    const CloudGrid grid = grid_for(view.geometry(), kWorkingRange).value();
    const Triangulation how = triangulation_for(view.geometry(), kWorkingRange, grid).value();
    std::vector<CloudPoint> room(left.pixels.size() + 64);
    void* at = room.data();
    std::size_t bytes = room.size() * sizeof(CloudPoint);
    std::align(Arena::kAlignment, left.pixels.size() * sizeof(CloudPoint), at, bytes);
    Arena arena({static_cast<std::byte*>(at), bytes});
    const PointCloud cloud = triangulate(matched.map(), left.view(), how, arena).cloud;
    scene.points.assign(cloud.points.begin(), cloud.points.end());
    scene.grid = cloud.grid;

    const TrueDepth depth = read_truth(folder);
    scene.picture_leaf = ids_of(folder + "/gt_leaf_id.png");
    const Surface surface(depth, scene.picture_leaf);
    std::ifstream file(folder + "/gt_info.json");
    const nlohmann::json about = nlohmann::json::parse(file);
    scene.above_soil_mm = about["height_above_soil_mm"].get<double>();
    scene.above_bench_mm = about["plant_height_mm"].get<double>();
    const Turn& rectifying = view.flat().left_rectifying;
    scene.ground = true_ground(about, rectifying);
    read_leaves(folder, surface, depth, rectifying, scene);

    const Turn back = transposed(rectifying);
    scene.at_pixel.assign(depth.pixels(), -1);
    const double step_mm = grid.step_um / 1000.0;
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        const CloudPoint& p = scene.points[i];
        const Point3 in_left = turned(back, {p.x * step_mm, p.y * step_mm, p.z * step_mm});
        const Point2 pixel = project(view.rig().left, in_left);
        const long x = std::lround(pixel.x), y = std::lround(pixel.y);
        const bool inside = x >= 0 && y >= 0 && x < depth.width && y < depth.height;
        const std::size_t k = inside ? surface.index(static_cast<int>(x), static_cast<int>(y)) : 0;
        scene.leaf.push_back(inside ? scene.picture_leaf[k] : 0);
        scene.off_mm.push_back(inside ? static_cast<float>(in_left.z) - depth.mm[k] : 0);
        if (inside)
            scene.at_pixel[k] = static_cast<std::int32_t>(i);
    }
    return scene;
}

} // namespace

const std::vector<LeafScene>& plant_scenes()
{
    static const std::vector<LeafScene> scenes = [] {
        std::vector<LeafScene> all;
        for (const char* plant : kPlants)
            for (const char* light : kLights)
                all.push_back(look_at(plant, light));
        return all;
    }();
    return scenes;
}

} // namespace dicot::test
