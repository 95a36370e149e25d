// A pair of recorded pictures before a flat wall, with its rig file and a configuration: the least that a snapshot
// needs.
#pragma once

#include "temp_folder.h"

#include <filesystem>
#include <random>
#include <string>

namespace dicot::test {

struct FlatPair
{
    int width = 96; ///< px
    int height = 64;
    int focal_px = 100;
    int shift_px = 8; ///< the wall stands at focal_px * 60 mm / shift_px

    /// One side: every pixel of the left one has a partner `shift_px` further left in the right one.
    Bytes side(bool right) const
    {
        const std::string head = "P6 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
        Bytes file(head.begin(), head.end());
        std::mt19937 random{7};
        Bytes row(static_cast<std::size_t>(width + shift_px) * 3);
        for (int y = 0; y < height; ++y) {
            for (std::uint8_t& value : row)
                value = static_cast<std::uint8_t>(random());
            const auto first = row.begin() + (right ? 3 * shift_px : 0);
            file.insert(file.end(), first, first + std::ptrdiff_t{3} * width);
        }
        return file;
    }

    /// Parallel cameras without distortion, as the cameras give their pictures.
    std::string rig(double near_mm, double far_mm) const
    {
        const auto matrix = [](const char* name, int columns, const std::string& data) {
            return std::string(name) + ": !!opencv-matrix\n   rows: 3\n   cols: " + std::to_string(columns) +
                   "\n   dt: d\n   data: [ " + data + " ]\n";
        };
        const std::string focal = std::to_string(focal_px) + ".";
        const std::string k = focal + ", 0., " + std::to_string((width - 1) / 2.0) + ", 0., " + focal + ", " +
                              std::to_string((height - 1) / 2.0) + ", 0., 0., 1.";
        return "%YAML:1.0\n---\nimage_width: " + std::to_string(width) + "\nimage_height: " + std::to_string(height) +
               "\nnear_mm: " + std::to_string(near_mm) + "\nfar_mm: " + std::to_string(far_mm) + "\n" +
               matrix("K1", 3, k) + matrix("K2", 3, k) + matrix("R", 3, "1., 0., 0., 0., 1., 0., 0., 0., 1.") +
               matrix("T", 1, "-60., 0., 0.");
    }

    /// pairs/, rig.yaml and dicot.toml, whose path it returns; `more`: further sections.
    std::string write(const TempFolder& folder, double near_mm, double far_mm, const std::string& more = "") const
    {
        std::filesystem::create_directories(folder.path("pairs"));
        folder.write("pairs/left01.ppm", side(false));
        folder.write("pairs/right01.ppm", side(true));
        folder.write("rig.yaml", rig(near_mm, far_mm));
        return folder.write("dicot.toml", "[cameras]\nleft = \"replay:pairs\"\nright = \"replay:pairs\"\n"
                                          "[rig]\nfile = \"rig.yaml\"\n"
                                          "[matching]\nwindow = 5\nthreads = 2\n"
                                          "[output]\nfolder = \"out\"\nreserve_mib = 0\ndevice = \"bench\"\n" +
                                              more);
    }
};

} // namespace dicot::test
