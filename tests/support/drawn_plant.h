// A cloud file of a small plant: flat green leaves over brown soil, as two cameras above would see it.
#pragma once

#include "dicot/codec/encode_cloud.h"
#include "dicot/codec/stored_point.h"

#include <cmath>
#include <cstddef>
#include <fstream>
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
    double slope = 0.5;

    double area_mm2() const { return leaves * kPi * radius_mm * radius_mm * std::sqrt(1 + slope * slope); }

    static constexpr double kPi = 3.14159265358979;
};

inline std::vector<CloudPoint> drawn_points(const DrawnPlant& plant)
{
    constexpr int kWidth = 320, kHeight = 240;
    constexpr double kFocal = 400, kSoilMm = 500, kLeafMm = 440, kStepMm = 0.1;
    std::vector<CloudPoint> points;
    for (int row = 0; row < kHeight; ++row)
        for (int column = 0; column < kWidth; ++column) {
            const double x = (column - 160.3) / kFocal, y = (row - 119.6) / kFocal;
            double depth = kSoilMm + 40 * y; // seen a little from the side
            Rgb8 colour{95, 70, 50};
            for (int leaf = 0; leaf < plant.leaves; ++leaf) {
                const double turn = 2 * DrawnPlant::kPi * leaf / plant.leaves;
                const double out_x = std::cos(turn), out_y = std::sin(turn);
                // z = kLeafMm + slope (out . (x z, y z) - ring): where the ray meets the leaf's plane.
                const double z = (kLeafMm - plant.slope * plant.ring_mm) / (1 - plant.slope * (out_x * x + out_y * y));
                const double dx = x * z - plant.ring_mm * out_x, dy = y * z - plant.ring_mm * out_y;
                if (dx * dx + dy * dy <= plant.radius_mm * plant.radius_mm) {
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

inline void write_plant(const std::string& path, const DrawnPlant& plant)
{
    const std::vector<CloudPoint> points = drawn_points(plant);
    const CloudGrid grid{.step_um = 100, .bits = 14, .origin = {-8192, -8192, 0}};
    std::vector<std::byte> heap(encode_heap_bytes(points.size()));
    const Result<EncodedCloud> packed = encode_cloud({points, grid}, CloudMeta{}, heap);
    if (!packed.ok())
        throw std::runtime_error(packed.status().message());
    const auto bytes = packed.value().bytes;
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

} // namespace dicot::test
