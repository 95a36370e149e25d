// A cloud file of a small plant: flat green leaves over brown soil, as two cameras above see it.
#pragma once

#include "dicot/codec/encode_cloud.h"
#include "dicot/codec/stored_point.h"

#include <cmath>
#include <cstddef>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace dicot::test {

/// Leaves on a ring, 60 mm above the soil, which is 500 mm away; each hangs down outwards. Seen from above they are
/// discs of `radius_mm`.
struct DrawnPlant
{
    int leaves = 4;
    double radius_mm = 14;
    double ring_mm = 60;
    double slope = 0;
    double down = 0.8660254; ///< sine of the angle by which the cameras look down

    double area_mm2() const { return leaves * kPi * radius_mm * radius_mm * std::sqrt(1 + slope * slope); }

    static constexpr double kPi = 3.14159265358979;
};

inline std::vector<CloudPoint> drawn_points(const DrawnPlant& plant)
{
    constexpr int kWidth = 320, kHeight = 240;
    constexpr double kFocal = 400, kStepMm = 0.1;
    const double level = std::sqrt(1 - plant.down * plant.down);
    const double middle_mm = 500 * level, soil_mm = -500 * plant.down;
    std::vector<CloudPoint> points;
    for (int row = 0; row < kHeight; ++row)
        for (int column = 0; column < kWidth; ++column) {
            // A ray, one mm forward: right, away and up of the scene.
            const double x = (column - 160.3) / kFocal, y = (row - 119.6) / kFocal;
            const double away = level - plant.down * y, up = -plant.down - level * y;
            double depth = soil_mm / up;
            Rgb8 colour{95, 70, 50};
            for (int leaf = 0; leaf < plant.leaves; ++leaf) {
                const double turn = 2 * DrawnPlant::kPi * leaf / plant.leaves;
                const double out_x = std::cos(turn), out_away = std::sin(turn);
                // Its plane: up = 60 mm above the soil + slope (ring - distance outwards).
                const double z = (soil_mm + 60 + plant.slope * (plant.ring_mm + out_away * middle_mm)) /
                                 (up + plant.slope * (out_x * x + out_away * away));
                const double dx = x * z - plant.ring_mm * out_x;
                const double dy = away * z - middle_mm - plant.ring_mm * out_away;
                if (z > 0 && z < depth && dx * dx + dy * dy <= plant.radius_mm * plant.radius_mm) {
                    depth = z;
                    colour = {60, 130, 50};
                }
            }
            points.push_back(as_stored({static_cast<std::int32_t>(std::lround(x * depth / kStepMm)),
                                        static_cast<std::int32_t>(std::lround(y * depth / kStepMm)),
                                        static_cast<std::int32_t>(std::lround(depth / kStepMm)), colour, 255}));
        }
    return points;
}

inline void write_points(const std::string& path, const std::vector<CloudPoint>& points)
{
    const CloudGrid grid{.step_um = 100, .bits = 14, .origin = {-8192, -8192, 0}};
    std::vector<std::byte> heap(encode_heap_bytes(points.size()));
    const Result<EncodedCloud> packed = encode_cloud({points, grid}, CloudMeta{}, heap);
    if (!packed.ok())
        throw std::runtime_error(packed.status().message());
    const auto bytes = packed.value().bytes;
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

inline void write_plant(const std::string& path, const DrawnPlant& plant)
{
    write_points(path, drawn_points(plant));
}

/// The same leaves before a thicket: a ray that meets the soil ends anywhere up to twice as far.
inline void write_plant_in_thicket(const std::string& path, const DrawnPlant& plant)
{
    std::vector<CloudPoint> points = drawn_points(plant);
    std::mt19937 random(7);
    for (CloudPoint& point : points)
        if (point.colour.r > point.colour.g) {
            const double farther = 1 + static_cast<double>(random() % 1000) / 1000;
            for (std::int32_t* axis : {&point.x, &point.y, &point.z})
                *axis = static_cast<std::int32_t>(std::lround(*axis * farther));
            point = as_stored(point);
        }
    write_points(path, points);
}

/// What is left of it in a night: a point here and there.
inline void write_specks(const std::string& path, const DrawnPlant& plant)
{
    constexpr std::size_t kApart = 1931;
    const std::vector<CloudPoint> all = drawn_points(plant);
    std::vector<CloudPoint> specks;
    for (std::size_t i = 0; i < all.size(); i += kApart)
        specks.push_back(all[i]);
    write_points(path, specks);
}

} // namespace dicot::test
