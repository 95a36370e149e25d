// A board with small recorded pictures, whose time is told: a slot takes milliseconds.
#pragma once

#include "temp_folder.h"
#include "tool.h"

#include "dicot/base/utc_time.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace dicot::test {

class RunOfOneBoard : public testing::Test
{
protected:
    static constexpr int kWidth = 80, kHeight = 60, kDisparity = 9;

    RunOfOneBoard()
    {
        std::filesystem::create_directory(own_.path("pairs"));
        write_picture("left", kDisparity);
        write_picture("right", 0);
        std::ofstream(own_.path("rig.yaml"))
            << "%YAML:1.0\n---\nid: \"run\"\nunit: mm\nimage_width: 80\nimage_height: 60\nnear_mm: 350\nfar_mm: 1200\n"
            << "P1: !!opencv-matrix\n   rows: 3\n   cols: 4\n   dt: d\n"
            << "   data: [ 100., 0., 40., 0., 0., 100., 30., 0., 0., 0., 1., 0. ]\n"
            << "P2: !!opencv-matrix\n   rows: 3\n   cols: 4\n   dt: d\n"
            << "   data: [ 100., 0., 40., -6000., 0., 100., 30., 0., 0., 0., 1., 0. ]\n";
        write_config();
    }

    /// The left picture is the right one moved: a wall 667 mm away.
    void write_picture(const std::string& side, int moved) const
    {
        std::mt19937 random{7};
        std::vector<std::uint8_t> wall(std::size_t{3} * (kWidth + kDisparity) * kHeight);
        for (std::uint8_t& value : wall)
            value = static_cast<std::uint8_t>(64 + random() % 128);
        std::ofstream file(own_.path("pairs/" + side + "01.ppm"), std::ios::binary);
        file << "P6 " << kWidth << " " << kHeight << " 255\n";
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < 3 * kWidth; ++x)
                file.put(static_cast<char>(
                    wall[static_cast<std::size_t>(3 * (y * (kWidth + kDisparity) + kDisparity - moved) + x)]));
    }

    void write_config(const std::string& cameras = "", const std::string& more = "",
                      const std::string& schedule = "every = '2h'\n") const
    {
        std::ofstream(own_.path("dicot.toml"))
            << "[cameras]\nleft = 'replay:pairs'\nright = 'replay:pairs'\n"
            << cameras << "[burst]\nframes = 1\n[matching]\nwindow = 3\nthreads = 1\n[rig]\nfile = 'rig.yaml'\n"
            << "[schedule]\ntimezone = 'UTC'\n"
            << schedule << "[output]\nfolder = 'store'\ndevice = 'bench'\nreserve_mib = " << reserve_mib_
            << "\n[run]\nstate = 'state'\n"
            << more;
    }

    std::string command(const std::string& words) const
    {
        return std::string{DICOT_PROGRAM} + " " + words + " --config " + own_.path("dicot.toml");
    }
    ToolRun dicot(const std::string& words) const { return run(command(words)); }
    ToolRun rehearse(int slots, const std::string& from) const
    {
        return dicot("run --rehearse " + std::to_string(slots) + (from.empty() ? "" : " --from " + from));
    }

    struct Row
    {
        std::int64_t sequence = 0;
        std::string due; ///< empty: none
        bool done = false;
        std::string reason;
    };
    /// As `dicot list` tells them.
    std::vector<Row> rows() const
    {
        const ToolRun told = run("{ " + command("list --json") + " 2>/dev/null; }");
        const nlohmann::json parsed = nlohmann::json::parse(told.output, nullptr, false);
        std::vector<Row> rows;
        if (!parsed.is_object() || parsed["stores"].empty())
            return rows;
        for (const nlohmann::json& slot : parsed["stores"][0]["slots"])
            rows.push_back({slot["sequence"].get<std::int64_t>(),
                            slot["due"].is_string() ? slot["due"].get<std::string>() : "", slot["outcome"] == "done",
                            slot["reason"].is_string() ? slot["reason"].get<std::string>() : ""});
        return rows;
    }
    /// The record of a slot.
    nlohmann::json record(std::int64_t sequence) const
    {
        const ToolRun told = run("{ " + command("show --json " + std::to_string(sequence)) + " 2>/dev/null; }");
        return nlohmann::json::parse(told.output, nullptr, false).value("record", nlohmann::json::object());
    }

    TempFolder own_;
    int reserve_mib_ = 0;
};

} // namespace dicot::test
