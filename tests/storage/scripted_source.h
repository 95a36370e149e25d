// A source in memory that does what a test wants, and counts what it is asked for.
#pragma once

#include "dicot/base/utc_time.h"
#include "dicot/os/sha256.h"
#include "dicot/pull_archive/pull_source.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace dicot::test {

using Files = std::vector<std::pair<std::string, std::string>>; ///< name, bytes

inline std::string sha256_text(const std::string& bytes)
{
    return hex_of(sha256_of(std::as_bytes(std::span(bytes)))).data();
}

inline std::string record_of(std::int64_t sequence, std::int64_t began_us, bool done = true)
{
    return R"({"format": "dicot record 1", "sequence": )" + std::to_string(sequence) + R"(, "time": ")" +
           utc_text(began_us).c_str() + R"(", "outcome": ")" + (done ? "done" : "missed") + R"(", "reason": )" +
           (done ? "null" : R"("no light")") + R"(, "clock": {"trust": "set"})" +
           (done ? R"(, "cloud": {"points": 5}})" : "}");
}

/// The files with the SHA256SUMS that fit them.
inline Files with_sums(Files files)
{
    std::string sums;
    for (const auto& [name, bytes] : files)
        sums += sha256_text(bytes) + "  " + name + "\n";
    files.emplace_back("SHA256SUMS", sums);
    return files;
}

struct ScriptedSnapshot
{
    OfferedSnapshot offer;
    Files files;
};

/// As a board has it: a record and a cloud of so many bytes, no two alike.
inline ScriptedSnapshot honest(std::int64_t sequence, std::int64_t began_us, std::size_t cloud_bytes)
{
    std::string cloud(cloud_bytes, '\0');
    std::uint32_t state = static_cast<std::uint32_t>(sequence) * 2654435761U + 1U;
    for (char& byte : cloud) {
        state = state * 1664525U + 1013904223U;
        byte = static_cast<char>(state >> 24U);
    }
    ScriptedSnapshot snapshot;
    snapshot.files = with_sums({{"cloud.drc", cloud}, {"record.json", record_of(sequence, began_us)}});
    snapshot.offer.sequence = sequence;
    snapshot.offer.began_us = began_us;
    snapshot.offer.sums =
        std::bit_cast<std::array<std::byte, 32>>(sha256_of(std::as_bytes(std::span(snapshot.files.back().second))));
    return snapshot;
}

class ScriptedSource : public PullSource
{
public:
    std::vector<ScriptedSnapshot> all;
    std::string serial_number = "10000000a";
    std::map<std::string, std::uint64_t> sizes; ///< instead of the true ones, by name
    std::size_t most_at_once = 64;              ///< bytes a read gives
    /// Reads that succeed before the source is gone.
    std::uint64_t reads_left = std::numeric_limits<std::uint64_t>::max();
    Fault then = Fault::kUnavailable;
    std::map<std::string, std::uint64_t> bytes_read; ///< by name
    std::uint64_t reads = 0;

    std::string_view device() const override { return "tent"; }
    std::string_view serial() const override { return serial_number; }
    std::string_view where() const override { return "a script"; }

    Status snapshots(std::int64_t first, FunctionRef<bool(const OfferedSnapshot&)> visit) override
    {
        for (const ScriptedSnapshot& one : all)
            if (one.offer.sequence >= first && !visit(one.offer))
                break;
        return {};
    }
    Status files(const OfferedSnapshot& snapshot, FunctionRef<bool(const OfferedFile&)> visit) override
    {
        at_ = nullptr;
        for (const ScriptedSnapshot& one : all)
            if (one.offer.sequence == snapshot.sequence && one.offer.began_us == snapshot.began_us)
                at_ = &one;
        if (at_ == nullptr)
            return failure(Fault::kNoInput, "it is pruned");
        for (std::size_t k = 0; k < at_->files.size(); ++k) {
            const auto& [name, bytes] = at_->files[k];
            const auto lie = sizes.find(name);
            if (!visit({name.c_str(), lie == sizes.end() ? bytes.size() : lie->second, k}))
                break;
        }
        return {};
    }
    Result<std::size_t> read(const OfferedFile& file, std::uint64_t offset, std::span<std::byte> into) override
    {
        ++reads;
        if (reads_left == 0)
            return failure(then, "it is gone");
        --reads_left;
        const auto& [name, bytes] = at_->files[static_cast<std::size_t>(file.handle)];
        const std::size_t from = static_cast<std::size_t>(std::min<std::uint64_t>(offset, bytes.size()));
        const std::size_t count = std::min({into.size(), most_at_once, bytes.size() - from});
        std::ranges::copy(std::as_bytes(std::span(bytes)).subspan(from, count), into.begin());
        bytes_read[name] += count;
        return count;
    }
    Status mark(std::span<const Pulled>) override { return failure(Fault::kUsage, "a script takes no marks"); }
    Status offer_time(std::int64_t) override { return failure(Fault::kUsage, "a script has no clock"); }

private:
    const ScriptedSnapshot* at_ = nullptr;
};

} // namespace dicot::test
