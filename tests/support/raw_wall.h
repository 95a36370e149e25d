// A textured wall as two webcams with lenses of their own would see it, in files, with its rig file.
#pragma once

#include "temp_folder.h"

#include "dicot/base/stereo_rig.h"
#include "dicot/rig/rig_file.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace dicot::test {

struct RawWall
{
    /// Slanted, so that disparities take all fractions of a pixel: in the frame of the left camera z = kDistanceMm +
    /// kSlope x, where the wall is kDistanceMm away straight ahead.
    static constexpr double kDistanceMm = 600;
    static constexpr double kSlope = 0.25;
    static double beyond_mm(const Point3& in_left) { return in_left.z - kDistanceMm - kSlope * in_left.x; }

    TempFolder folder;
    StereoRig rig;
    std::string left, right, rig_path, maps_path;

    RawWall()
    {
        rig.width = 320;
        rig.height = 180;
        rig.left = {195, 196, 160.5, 88, {-0.11, 0.04, 0.0008, -0.0009}};
        rig.right = {197, 196, 158, 91, {-0.13, 0.03, -0.0006, 0.0011}};
        // By 0.02 about y, then by -0.015 about x, as 3-4-5-like exact rotations would: sines and their cosines.
        const double a = 0.02, b = -0.015, ca = std::sqrt(1 - a * a), cb = std::sqrt(1 - b * b);
        rig.turn = product({1, 0, 0, 0, cb, -b, 0, b, cb}, {ca, 0, a, 0, 1, 0, -a, 0, ca});
        rig.shift_mm = {-85, 1, 1.5};
        left = folder.write("left.ppm", seen_by(rig.left, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {}));
        const Turn back = transposed(rig.turn);
        const Point3 eye = turned(back, {-rig.shift_mm.x, -rig.shift_mm.y, -rig.shift_mm.z});
        right = folder.write("right.ppm", seen_by(rig.right, back, eye));
        rig_path = folder.path("rig.yaml");
        maps_path = folder.path("rig.maps");
        write_rig(rig);
    }
    std::string pair() const { return left + " " + right; }
    std::string process(const std::string& output) const
    {
        return "process " + pair() + " --rig " + rig_path + " --window 9 -o " + folder.path(output);
    }
    void write_rig(const StereoRig& cameras) const
    {
        RigFile file;
        file.width = cameras.width;
        file.height = cameras.height;
        file.near_mm = 400;
        file.far_mm = 900;
        set_camera(file.left, cameras.left);
        set_camera(file.right, cameras.right);
        const Turn& r = cameras.turn;
        file.rotation = {{{r[0], r[1], r[2]}, {r[3], r[4], r[5]}, {r[6], r[7], r[8]}}};
        file.translation_mm = {cameras.shift_mm.x, cameras.shift_mm.y, cameras.shift_mm.z};
        if (!write_rig_file(rig_path.c_str(), file).ok())
            throw std::runtime_error("cannot write " + rig_path);
    }

private:
    static void set_camera(RigCamera& camera, const Lens& lens)
    {
        camera.intrinsic = {{{lens.fx, 0, lens.cx}, {0, lens.fy, lens.cy}, {0, 0, 1}}};
        camera.distortion = Distortion{4, {lens.k[0], lens.k[1], lens.k[2], lens.k[3]}};
    }
    /// A brightness for each knot of a grid on the wall.
    static double knot(int column, int row, int channel)
    {
        std::uint32_t hash = static_cast<std::uint32_t>(column) * 2654435761u ^
                             static_cast<std::uint32_t>(row) * 2246822519u ^
                             static_cast<std::uint32_t>(channel) * 3266489917u;
        hash = (hash ^ (hash >> 15)) * 2246822519u;
        return static_cast<double>((hash ^ (hash >> 13)) >> 24);
    }
    static std::uint8_t texture(double x_mm, double y_mm, int channel)
    {
        constexpr double kKnotMm = 12; // 4 px
        const double u = x_mm / kKnotMm, v = y_mm / kKnotMm;
        const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
        const double a = u - column, b = v - row;
        return static_cast<std::uint8_t>(
            (1 - b) * ((1 - a) * knot(column, row, channel) + a * knot(column + 1, row, channel)) +
            b * ((1 - a) * knot(column, row + 1, channel) + a * knot(column + 1, row + 1, channel)) + 0.5);
    }
    Bytes seen_by(const Lens& lens, const Turn& left_from_camera, const Point3& eye) const
    {
        const std::string head = "P6 " + std::to_string(rig.width) + " " + std::to_string(rig.height) + " 255\n";
        Bytes file(head.begin(), head.end());
        for (int y = 0; y < rig.height; ++y)
            for (int x = 0; x < rig.width; ++x) {
                const Point2 seen = undistort(lens, {static_cast<double>(x), static_cast<double>(y)}).value();
                const Point3 ray = turned(left_from_camera, {seen.x, seen.y, 1});
                const double way = -beyond_mm(eye) / (ray.z - kSlope * ray.x);
                for (int channel = 0; channel < 3; ++channel)
                    file.push_back(texture(eye.x + way * ray.x, eye.y + way * ray.y, channel));
            }
        return file;
    }
};

} // namespace dicot::test
