// A board's folder as a pull leaves it, with any clouds and misses in it.
#pragma once

#include "dicot/base/utc_time.h"
#include "dicot/os/sha256.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace dicot::test {

class ArchiveFolder
{
public:
    /// `clock`: how far its clock is believed: "synchronised", "set", "not set".
    ArchiveFolder(const std::string& root, const std::string& device, std::string zone = "UTC",
                  std::string clock = "synchronised")
        : board_(std::filesystem::path(root) / device), zone_(std::move(zone)), clock_(std::move(clock))
    {
        std::filesystem::create_directories(board_);
        std::ofstream(board_ / "ARCHIVE");
    }

    /// `when`: "2026-06-01T12:00:00Z". Returns the snapshot's folder.
    std::filesystem::path done(int sequence, const std::string& when, const std::string& cloud)
    {
        const std::filesystem::path folder = folder_of(sequence, when);
        std::filesystem::copy_file(cloud, folder / "cloud.drc");
        record(folder, sequence, when, R"("outcome": "done", "reason": null, "cloud": {"points": 1})");
        return folder;
    }

    std::filesystem::path missed(int sequence, const std::string& when, const std::string& reason)
    {
        const std::filesystem::path folder = folder_of(sequence, when);
        record(folder, sequence, when, R"("outcome": "missed", "reason": ")" + reason + "\"");
        return folder;
    }

    /// Of the slots that are added from now on.
    void believe_clock(const std::string& clock) { clock_ = clock; }

private:
    std::filesystem::path folder_of(int sequence, const std::string& when) const
    {
        char name[32];
        std::snprintf(name, sizeof name, "%06d_%s", sequence, utc_stamp(parse_utc_text(when).value()).c_str());
        const std::filesystem::path folder = board_ / when.substr(0, 10) / name;
        std::filesystem::create_directories(folder);
        return folder;
    }

    void record(const std::filesystem::path& folder, int sequence, const std::string& when, const std::string& outcome)
    {
        std::ofstream(folder / "record.json")
            << R"({"format": "dicot record 1", "sequence": )" << sequence << R"(, "time": ")" << when
            << R"(", "due": ")" << when << R"(", "clock": {"trust": ")" << clock_
            << R"("}, "parameters": {"schedule": {"timezone": ")" << zone_ << R"("}}, )" << outcome << "}";
        std::set<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            files.insert(entry.path());
        std::string sums;
        for (const std::filesystem::path& file : files) {
            std::ifstream stream(file, std::ios::binary);
            const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
            sums += std::string{hex_of(sha256_of(std::as_bytes(std::span{bytes}))).data()} + "  " +
                    file.filename().string() + "\n";
        }
        std::ofstream(folder / "SHA256SUMS") << sums;
    }

    std::filesystem::path board_;
    std::string zone_, clock_;
};

} // namespace dicot::test
