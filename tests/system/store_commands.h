// A store of one board made by dicot itself, and copies of it to spoil.
#pragma once

#include "cameras/drawn_pair.h"
#include "temp_folder.h"
#include "tool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace dicot::test {

inline std::string text_of(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void flip_a_bit(const std::filesystem::path& path, std::size_t at)
{
    std::string text = text_of(path);
    text.at(at) = static_cast<char>(text.at(at) ^ 1);
    std::ofstream(path, std::ios::binary) << text;
}

/// Slots 1 and 3 are done, 2 is missed: a camera was pulled out. The board is called "bench".
class StoreOfOneBoard : public testing::Test
{
protected:
    static constexpr int kMissed = 2;

    static void SetUpTestSuite()
    {
        folder_ = new TempFolder;
        app::Config config;
        app::DrawnRig drawn;
        ASSERT_TRUE(drawn.open(config).ok());
        const std::filesystem::path from = config.cameras.left.what;
        std::filesystem::create_directory(folder_->path("pairs"));
        for (const char* side : {"left", "right"})
            std::filesystem::copy(from / (std::string(side) + ".png"),
                                  folder_->path(std::string("pairs/") + side + "01.png"));
        std::filesystem::copy(config.rig.file, folder_->path("rig.yaml"));
        for (int slot = 1; slot <= 3; ++slot) {
            const ToolRun run = snap(folder_->path("first"), slot == kMissed ? "replay_script_left = 'gone 1'\n" : "");
            ASSERT_EQ(run.exit_code, slot == kMissed ? 69 : 0) << run.output;
        }
    }
    static void TearDownTestSuite()
    {
        delete folder_;
        folder_ = nullptr;
    }

    static ToolRun dicot(const std::string& words) { return run(std::string{DICOT_PROGRAM} + " " + words); }
    /// A configuration of small pictures and windows; the words that name it.
    static std::string config(const std::string& cameras = "", const std::string& output = "")
    {
        std::ofstream(folder_->path("dicot.toml"))
            << "[cameras]\nleft = 'replay:pairs'\nright = 'replay:pairs'\n"
            << cameras << "[burst]\nframes = 1\n[matching]\nwindow = 3\n[rig]\nfile = 'rig.yaml'\n"
            << "[output]\ndevice = 'bench'\n"
            << output;
        return " --config " + folder_->path("dicot.toml") + " ";
    }
    static ToolRun snap(const std::string& root, const std::string& cameras = "", const std::string& output = "")
    {
        return dicot("snap -o " + root + config(cameras, output));
    }

    /// A fresh copy to spoil; its root.
    std::string copy() const
    {
        const std::string root = own_.path("root" + std::to_string(own_.files()));
        std::filesystem::copy(folder_->path("first"), root, std::filesystem::copy_options::recursive);
        return root;
    }
    /// A command upon this store alone.
    static ToolRun ask(const std::string& command, const std::string& root, const std::string& more = "")
    {
        return dicot(command + " --store '" + root + "'" + config() + more);
    }
    /// Its report as JSON.
    static nlohmann::json report(const std::string& command, const std::string& root)
    {
        const ToolRun told = run("{ " + std::string{DICOT_PROGRAM} + " " + command + " --json --store '" + root + "'" +
                                 config() + "2>/dev/null; }");
        nlohmann::json parsed = nlohmann::json::parse(told.output, nullptr, false);
        EXPECT_TRUE(parsed.is_object()) << told.output;
        return parsed;
    }
    static std::vector<std::filesystem::path> snapshots(const std::string& root)
    {
        std::vector<std::filesystem::path> folders;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
            if (entry.path().filename() == "record.json")
                folders.push_back(entry.path().parent_path());
        std::sort(folders.begin(), folders.end());
        return folders;
    }

    static TempFolder* folder_;
    TempFolder own_;
};
inline TempFolder* StoreOfOneBoard::folder_ = nullptr;

} // namespace dicot::test
